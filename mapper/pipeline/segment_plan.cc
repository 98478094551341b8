#include "mapper/pipeline/segment_plan.h"

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

Result<SegmentPlan> plan_segment(const Drive& drive, double min_spacing_m) {
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
  return SegmentPlan{drive.name, std::move(frame_indices), std::move(*line)};
}

StoredSegment stored_segment(const SegmentPlan& plan) {
  StoredSegment segment{plan.id, plan.line.length_m(), {}, {}};
  for (std::size_t i = 0; i < plan.line.vertices().size(); ++i) {
    const GeoPoint& vertex = plan.line.vertices()[i];
    segment.vertices.push_back(
        {vertex.latitude_deg, vertex.longitude_deg, vertex.altitude_m, plan.line.along_m()[i]});
  }
  return segment;
}

}  // namespace milepost
