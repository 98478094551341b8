// The landmarks around the vehicle in one tangent frame.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "client/localize/tile_window.h"
#include "client/localize/unrolled_road.h"
#include "schema/geo/route_line.h"
#include "schema/tile/landmark.h"

namespace milepost {

// A landmark in the tangent frame of the window, with arc lengths of the current segment's way.
struct LocalLandmark {
  CompactDescriptor descriptor{};
  Eigen::Vector3d enu_m;        // in the window's tangent frame
  Eigen::Vector3d mapping_ray;  // unit vector towards it from the middle of where it was mapped
  double mapped_at_m = 0;       // arc length of that middle
  double mapped_ahead_m = 0;    // how far ahead it is from there, in the line's direction
  double depth_sigma_m = 0;     // of its position, along the mapping ray
  double size_m = 0;
  double size_sigma = 0;  // of ln(size)
  AlongRange along;
  // Whether it must be seen where it was mapped: not one of another way through a junction.
  bool is_of_this_way = true;
};

// Not safe to use from several threads at once.
class LandmarkWindow {
 public:
  // Empty, with the origin of its tangent frame.
  LandmarkWindow(const WindowReach& reach, const GeoPoint& origin);

  // Loads every held landmark whose range meets `range` of the current segment's way and discards
  // others: those of the current segment, of what lies ahead on all branches, and of what lies
  // behind, as far as their maps have the same features and codebook. REQUIRES: a road as of
  // unrolled_road().
  Covered cover(const HeldMap& held, const std::vector<UnrolledSegment>& road,
                const AlongRange& range);
  // Moves the origin of the tangent frame.
  void set_origin(const GeoPoint& origin);

  // Valid until the next cover() or set_origin(). Those of the current segment come first.
  const std::vector<LocalLandmark>& landmarks() const { return landmarks_; }
  const LocalFrame& frame() const { return frame_; }

 private:
  // The tiles of one segment, and where it lies on the current one's way.
  struct Part {
    UnrolledSegment segment;
    TileWindow<LandmarkTile> tiles;
  };

  void rebuild();
  LocalLandmark placed(const Landmark& landmark, const LocalFrame& tile_frame,
                       const UnrolledSegment& segment) const;

  WindowReach reach_;
  LocalFrame frame_;
  std::vector<Part> parts_;  // the current segment's first
  std::vector<LocalLandmark> landmarks_;
};

}  // namespace milepost
