#include "client/global/view_sections.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace milepost {
namespace {

double bearing_rad(const Eigen::Vector3d& level) { return std::atan2(level.x(), level.z()); }

// A line on a wall: the bearings that it covers and its direction.
struct WallSpan {
  BearingRange bearings;
  std::size_t direction = 0;
};

std::vector<WallSpan> wall_spans_of(const VanishingDirections& found, const Pinhole& view,
                                    const Eigen::Matrix3d& level) {
  std::vector<WallSpan> wall_spans;
  for (const VanishingLine& line : found.lines) {
    if (!line.direction) continue;
    if (found.directions[*line.direction].orientation != Orientation::horizontal) continue;
    const Eigen::Vector3d start = level * direction_of_pixel(view, line.segment.start_px);
    const Eigen::Vector3d end = level * direction_of_pixel(view, line.segment.end_px);
    if (std::min(start.y(), end.y()) >= 0) continue;  // below the horizon
    if (start.z() <= 0 || end.z() <= 0) continue;
    const double start_rad = bearing_rad(start);
    const double end_rad = bearing_rad(end);
    if (start_rad == end_rad) continue;
    wall_spans.push_back(
        {{std::min(start_rad, end_rad), std::max(start_rad, end_rad)}, *line.direction});
  }
  return wall_spans;
}

}  // namespace

Eigen::Matrix3d level_from_camera(const VanishingDirections& found) {
  if (found.directions.empty() || found.directions.front().orientation != Orientation::vertical) {
    return Eigen::Matrix3d::Identity();
  }
  // Up is (0, -1, 0) for an upright camera: undoes first the roll, then the pitch.
  const Eigen::Vector3d& up = found.directions.front().direction;
  const double roll_rad = std::atan2(up.x(), -up.y());
  const double pitch_rad = std::atan2(up.z(), std::hypot(up.x(), up.y()));
  return (Eigen::AngleAxisd(pitch_rad, Eigen::Vector3d::UnitX()) *
          Eigen::AngleAxisd(-roll_rad, Eigen::Vector3d::UnitZ()))
      .toRotationMatrix();
}

std::vector<ViewSection> view_sections(const VanishingDirections& found, const Pinhole& view) {
  const Eigen::Matrix3d level = level_from_camera(found);
  const std::vector<WallSpan> wall_spans = wall_spans_of(found, view, level);
  std::vector<double> borders_rad;
  for (const WallSpan& span : wall_spans) {
    borders_rad.push_back(span.bearings.from_rad);
    borders_rad.push_back(span.bearings.to_rad);
  }
  std::ranges::sort(borders_rad);

  std::vector<ViewSection> sections;
  std::vector<bool> before;  // the directions seen in the previous section
  for (std::size_t i = 1; i < borders_rad.size(); ++i) {
    const BearingRange between{borders_rad[i - 1], borders_rad[i]};
    if (between.width_rad() <= 0) continue;
    std::vector<bool> seen(found.directions.size(), false);
    for (const WallSpan& span : wall_spans) {
      const bool spans =
          span.bearings.from_rad <= between.from_rad && span.bearings.to_rad >= between.to_rad;
      if (spans) seen[span.direction] = true;
    }
    const bool goes_on =
        !sections.empty() && seen == before && sections.back().bearings.to_rad == between.from_rad;
    before = seen;
    if (goes_on) {
      sections.back().bearings.to_rad = between.to_rad;
      continue;
    }
    ViewSection section{between, {}};
    for (std::size_t k = 0; k < seen.size(); ++k) {
      if (seen[k])
        section.orientations_rad.push_back(bearing_rad(level * found.directions[k].direction));
    }
    if (!section.orientations_rad.empty()) sections.push_back(section);
  }
  return sections;
}

}  // namespace milepost
