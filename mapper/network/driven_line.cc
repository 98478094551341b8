#include "mapper/network/driven_line.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "schema/base/ids.h"
#include "schema/base/median.h"

namespace milepost {
namespace {

using FrameIndices = std::vector<std::size_t>;

double spacing_m(const Frame& from, const Frame& to) {
  return geodesic_distance_m(from.position, to.position);
}

// How far `to` lies ahead of `from`, by the mean of their headings; negative behind it.
double ahead_m(const Frame& from, const Frame& to) {
  const double mean_deg = from.heading_deg + turn_deg(from.heading_deg, to.heading_deg) / 2;
  const double azimuth_deg = geodesic_azimuth_deg(from.position, to.position);
  return spacing_m(from, to) * std::cos(turn_deg(mean_deg, azimuth_deg) * kRadPerDeg);
}

// Of consecutive frames of the moving vehicle; 0 if it never moves.
double median_spacing_m(const Drive& drive) {
  std::vector<double> spacings_m;
  for (std::size_t i = 1; i < drive.frames.size(); ++i) {
    const double moved_m = spacing_m(drive.frames[i - 1], drive.frames[i]);
    if (moved_m > 0.1) spacings_m.push_back(moved_m);
  }
  return spacings_m.empty() ? 0 : median_of(std::move(spacings_m));
}

std::string metres_text(double length_m) { return std::to_string(std::lround(length_m)) + " m"; }

// Lays one drive's lines, frame by frame.
class LineLayer {
 public:
  LineLayer(const Drive& drive, const DrivenLineSettings& settings)
      : drive_(drive),
        settings_(settings),
        max_gap_m_(std::max(settings.max_gap_m, 5 * median_spacing_m(drive))) {}

  NamedDrivenLines lay() {
    for (std::size_t i = 0; i < drive_.frames.size(); ++i) {
      if (i > 0 && is_pause(i - 1, i)) {
        tell("pause", i - 1,
             "a pause of " + metres_text(spacing_m(frame(i - 1), frame(i))) +
                 " without frames, so no road is laid across it");
        finish_line();
      }
      add(i);
    }
    finish_line();
    return std::move(found_);
  }

 private:
  const Frame& frame(std::size_t i) const { return drive_.frames[i]; }

  bool is_pause(std::size_t from, std::size_t to) const {
    const double moved_m = spacing_m(frame(from), frame(to));
    const double waited_s = frame(to).timestamp_s - frame(from).timestamp_s;
    return moved_m > max_gap_m_ ||
           (moved_m > settings_.max_pause_m && waited_s > settings_.max_pause_s);
  }

  // `progress_m_` counts the way forwards since the last vertex, ways back subtracted: a standing
  // vehicle's drift adds to it no more than its extent.
  void add(std::size_t i) {
    if (vertices_.empty()) {
      take(i);
      return;
    }
    progress_m_ += ahead_m(frame(i - 1), frame(i));
    if (progress_m_ < rearmost_m_) {
      rearmost_m_ = progress_m_;
      rearmost_ = i;
    }
    if (progress_m_ < settings_.min_frame_spacing_m) return;
    const bool reversed = rearmost_m_ < -settings_.min_reversing_m;
    if (reversed && !continues_line(i)) {
      start_again_at(rearmost_, i);
      return;
    }
    if (reversed) tell_reversing();
    take(i);
  }

  void take(std::size_t i) {
    vertices_.push_back(i);
    progress_m_ = 0;
    rearmost_m_ = 0;
  }

  // Whether the vehicle, having reversed and driven forwards as far, goes on where the line ends.
  bool continues_line(std::size_t i) const {
    const Frame& end = frame(vertices_.back());
    return std::abs(turn_deg(end.heading_deg, frame(i).heading_deg)) < 30 &&
           spacing_m(end, frame(i)) < std::max(3.0, 2 * progress_m_);
  }

  void start_again_at(std::size_t first, std::size_t last) {
    finish_line();
    for (std::size_t i = first; i <= last; ++i) add(i);
  }

  void tell_reversing() {
    tell(
        "reversing", vertices_.back(),
        "the vehicle reversed by " + metres_text(-rearmost_m_) + ", which is left out of the road");
  }

  void tell(const std::string& kind, std::size_t i, const std::string& what) {
    found_.findings.push_back({kind, "drive '" + drive_.name + "', frame " + frame(i).filename,
                               frame(i).line, 1, what, ""});
  }

  void finish_line() {
    if (!vertices_.empty() && rearmost_m_ < -settings_.min_reversing_m) tell_reversing();
    std::vector<GeoPoint> points;
    points.reserve(vertices_.size());
    for (const std::size_t i : vertices_) points.push_back(frame(i).position);
    Result<RouteLine> line = RouteLine::from_vertices(std::move(points));
    if (line.ok() && line->length_m() >= settings_.min_length_m) {
      found_.lines.push_back({std::move(vertices_), std::move(*line)});
    }
    vertices_ = {};
  }

  const Drive& drive_;
  const DrivenLineSettings& settings_;
  double max_gap_m_;
  FrameIndices vertices_;  // of the line being laid
  double progress_m_ = 0;
  double rearmost_m_ = 0;  // the least progress since the last vertex, and where it was
  std::size_t rearmost_ = 0;
  NamedDrivenLines found_;
};

}  // namespace

Result<NamedDrivenLines> driven_lines(const Drive& drive, const DrivenLineSettings& settings) {
  if (!is_segment_id(drive.name)) {
    return Error{ErrorCode::invalid_input, (drive.folder / "drive.json").string(),
                 "the name '" + drive.name + "' cannot be part of a segment id",
                 "use 1 to 64 letters, digits, '.', '_' or '-'"};
  }
  NamedDrivenLines lines = LineLayer(drive, settings).lay();
  lines.name = drive.name;
  if (lines.lines.empty()) {
    return Error{ErrorCode::invalid_input, (drive.folder / "trajectory.csv").string(),
                 "the vehicle does not move forwards, so there is no road to map",
                 "record it driving, or lower min-frame-spacing-m"};
  }
  return lines;
}

}  // namespace milepost
