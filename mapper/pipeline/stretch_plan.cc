#include "mapper/pipeline/stretch_plan.h"

#include <cmath>

namespace milepost {
namespace {

std::vector<std::size_t> spaced_frames(const Drive& drive, double min_spacing_m) {
  std::vector<std::size_t> taken;
  for (std::size_t i = 0; i < drive.frames.size(); ++i) {
    const bool apart =
        taken.empty() || geodesic_distance_m(drive.frames[taken.back()].position,
                                             drive.frames[i].position) >= min_spacing_m;
    if (apart) taken.push_back(i);
  }
  return taken;
}

}  // namespace

RouteLine part_of(const RouteLine& line, const AlongRange& range) {
  constexpr double kSameVertexM = 1e-6;
  if (range.from_m <= 0 && range.to_m >= line.length_m()) return line;
  std::vector<GeoPoint> vertices = {line.point_at(range.from_m)};
  for (std::size_t i = 0; i < line.vertices().size(); ++i) {
    const double along_m = line.along_m()[i];
    if (along_m > range.from_m + kSameVertexM && along_m < range.to_m - kSameVertexM)
      vertices.push_back(line.vertices()[i]);
  }
  vertices.push_back(line.point_at(range.to_m));
  return RouteLine::from_vertices(std::move(vertices)).value();
}

Result<StretchPlan> plan_stretch(const Drive& drive, double min_spacing_m,
                                 const std::vector<double>& cuts_m) {
  const std::string place = (drive.folder / "drive.json").string();
  if (!is_segment_id(drive.name)) {
    return Error{ErrorCode::invalid_input, place,
                 "the name '" + drive.name + "' is not a valid segment id",
                 "use 1 to 64 letters, digits, '.', '_' or '-'"};
  }
  std::vector<std::size_t> frame_indices = spaced_frames(drive, min_spacing_m);
  std::vector<GeoPoint> vertices;
  vertices.reserve(frame_indices.size());
  for (const std::size_t i : frame_indices) vertices.push_back(drive.frames[i].position);
  Result<RouteLine> line = RouteLine::from_vertices(std::move(vertices));
  if (!line) {
    return Error{ErrorCode::invalid_input, (drive.folder / "trajectory.csv").string(),
                 "the vehicle does not move, so there is no road to map",
                 "record it driving, or lower min-frame-spacing-m"};
  }
  std::vector<SegmentCut> segments;
  double from_m = 0;
  const auto cut_at = [&](double to_m) {
    const std::string id =
        cuts_m.empty() ? drive.name : drive.name + "-" + std::to_string(std::lround(from_m));
    segments.push_back({id, {from_m, to_m}, part_of(*line, {from_m, to_m})});
    from_m = to_m;
  };
  for (const double cut_m : cuts_m) cut_at(cut_m);
  cut_at(line->length_m());
  return StretchPlan{std::move(frame_indices), std::move(*line), std::move(segments)};
}

StoredSegment stored_segment(const SegmentCut& segment) {
  StoredSegment stored{segment.id, segment.line.length_m(), {}, {}};
  for (std::size_t i = 0; i < segment.line.vertices().size(); ++i) {
    const GeoPoint& vertex = segment.line.vertices()[i];
    stored.vertices.push_back(
        {vertex.latitude_deg, vertex.longitude_deg, vertex.altitude_m, segment.line.along_m()[i]});
  }
  return stored;
}

}  // namespace milepost
