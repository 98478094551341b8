// The landmarks around the vehicle, in one tangent frame.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "client/localize/tile_window.h"
#include "schema/geo/route_line.h"
#include "schema/tile/landmark.h"

namespace milepost {

// A landmark as the localizer sees it.
struct PlacedLandmark {
  CompactDescriptor descriptor{};
  Eigen::Vector3d enu_m;        // in the window's frame
  Eigen::Vector3d mapping_ray;  // unit vector from where it was mapped towards it, along which its
  double depth_sigma_m = 0;     // ... position is uncertain
  double size_m = 0;
  double size_sigma = 0;  // of ln size
  AlongRange along;
};

// Not safe to use from several threads at once.
class LandmarkWindow {
 public:
  // REQUIRES: `line` outlives the window.
  LandmarkWindow(SegmentKey segment, const WindowReach& reach, const RouteLine& line);

  // Takes every landmark that is held and whose along range meets `range`, and lets go of others.
  Covered cover(const HeldMap& held, const AlongRange& range);
  // Moves the frame's origin to `origin`.
  void set_origin(const GeoPoint& origin);

  // Valid until the next cover() or set_origin().
  const std::vector<PlacedLandmark>& landmarks() const { return landmarks_; }
  const LocalFrame& frame() const { return frame_; }

 private:
  void rebuild();

  TileWindow<LandmarkTile> tiles_;
  const RouteLine& line_;
  LocalFrame frame_;
  std::vector<PlacedLandmark> landmarks_;
};

}  // namespace milepost
