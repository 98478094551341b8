// The landmarks around the vehicle in one tangent frame.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "client/localize/tile_window.h"
#include "schema/geo/route_line.h"
#include "schema/tile/landmark.h"

namespace milepost {

// A landmark in the tangent frame of the window.
struct LocalLandmark {
  CompactDescriptor descriptor{};
  Eigen::Vector3d enu_m;        // in the window's tangent frame
  Eigen::Vector3d mapping_ray;  // unit vector towards it from the middle of where it was mapped
  double depth_sigma_m = 0;     // of its position, along the mapping ray
  double size_m = 0;
  double size_sigma = 0;  // of ln(size)
  AlongRange along;
};

// Not safe to use from several threads at once.
class LandmarkWindow {
 public:
  // REQUIRES: `line` outlives the window.
  LandmarkWindow(SegmentKey segment, const WindowReach& reach, const RouteLine& line);

  // Loads every held landmark whose arc length range meets `range` and discards others.
  Covered cover(const HeldMap& held, const AlongRange& range);
  // Moves the origin of the tangent frame.
  void set_origin(const GeoPoint& origin);

  // Valid until the next cover() or set_origin().
  const std::vector<LocalLandmark>& landmarks() const { return landmarks_; }
  const LocalFrame& frame() const { return frame_; }

 private:
  void rebuild();

  TileWindow<LandmarkTile> tiles_;
  const RouteLine& line_;
  LocalFrame frame_;
  std::vector<LocalLandmark> landmarks_;
};

}  // namespace milepost
