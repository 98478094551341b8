#include "client/localize/landmark_window.h"

namespace milepost {
namespace {

Eigen::Vector3d vector_from(const EnuPoint& point) {
  return {point.east_m, point.north_m, point.up_m};
}

}  // namespace

LandmarkWindow::LandmarkWindow(SegmentKey segment, const WindowReach& reach, const RouteLine& line)
    : tiles_(std::move(segment), reach), line_(line), frame_(line.point_at(0)) {}

Covered LandmarkWindow::cover(const HeldMap& held, const AlongRange& range) {
  Covered covered = tiles_.cover(held, range);
  if (covered.changed) rebuild();
  return covered;
}

void LandmarkWindow::set_origin(const GeoPoint& origin) {
  frame_ = LocalFrame(origin);
  rebuild();
}

void LandmarkWindow::rebuild() {
  landmarks_.clear();
  tiles_.for_each([this](const LandmarkTile& tile) {
    const LocalFrame tile_frame(line_.point_at(tile.origin_m));
    for (const Landmark& landmark : tile.landmarks) {
      LocalLandmark placed;
      placed.descriptor = landmark.descriptor;
      placed.enu_m = vector_from(frame_.enu_from_geo(tile_frame.geo_from_enu(landmark.position)));
      const double middle_m = (landmark.along.from_m + landmark.along.to_m) / 2;
      const Eigen::Vector3d mapped_from =
          vector_from(frame_.enu_from_geo(line_.point_at(middle_m)));
      placed.mapping_ray = (placed.enu_m - mapped_from).normalized();
      placed.depth_sigma_m = landmark.depth_sigma_m;
      placed.size_m = landmark.size_m;
      placed.size_sigma = landmark.size_sigma;
      placed.along = landmark.along;
      landmarks_.push_back(placed);
    }
  });
}

}  // namespace milepost
