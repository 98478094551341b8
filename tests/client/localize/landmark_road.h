// A road with landmarks as a map, and the observations of a camera that drives there.
#pragma once

#include <memory>
#include <random>

#include "client/fetch/map_source.h"
#include "client/fetch/nearby.h"
#include "client/localize/localizer.h"
#include "schema/feature/pca_projection.h"
#include "schema/geo/camera.h"
#include "schema/geo/camera_pose.h"
#include "schema/geo/route_line.h"
#include "schema/tile/landmark.h"
#include "tests/client/fetch/memory_source.h"
#include "tests/support/descriptors.h"

namespace milepost::testing {

// The pose of a vehicle on the road.
struct RoadPose {
  double along_m = 0;
  double lateral_m = 0;  // to the right
  double yaw_deg = 0;    // of the direction of travel against the road, clockwise
};

// 600 m: to the north, uphill by 3 %, then through a bend of 90 degrees to the right, then east.
// Landmarks stand to both sides.
class LandmarkRoad {
 public:
  static constexpr double kLengthM = 600;
  static constexpr double kTileM = 20;
  static constexpr Pinhole kCamera = {700, 710, 600, 200};
  static constexpr int kWidthPx = 1200;
  static constexpr int kHeightPx = 400;

  LandmarkRoad();

  const RouteLine& line() const { return line_; }
  const PcaProjection& projection() const { return projection_; }
  // Of a segment, which is a part of the road between whole metres.
  RouteLine line_of(const AlongRange& part) const;
  // The landmarks that are seen from it, also beyond its end.
  std::vector<LandmarkTile> tiles(const std::string& segment, const AlongRange& part) const;
  Camera query_camera() const;

  // Of the direction of travel, clockwise from north.
  double course_deg(const RoadPose& at) const;
  // The features observed by a camera whose mounting is rotated by `mounting_deg` clockwise, with
  // noise of 0.5 px and 5 % of scale (one sigma).
  FeatureSet observe(const RoadPose& at, double mounting_deg, std::mt19937& random) const;

 private:
  struct Thing {
    GeoPoint position;
    double along_m = 0;  // arc length of the road next to it
    double size_m = 0;
    Descriptor descriptor{};
  };

  RouteLine line_;
  std::vector<Thing> things_;
  PcaProjection projection_;
};

// The road, created once for all tests.
const LandmarkRoad& shared_road();

// Settings that hold little map data and retry soon after failures.
LocalizerSettings settings_of_a_short_reach();

// The map of the road as one segment, "road".
std::shared_ptr<MemorySource> map_of(const LandmarkRoad& road);
// As segments "road-0", "road-CUT", ..., each of which overlaps the next by 5 m.
std::shared_ptr<MemorySource> map_of(const LandmarkRoad& road, const std::vector<double>& cuts_m);
// The map of some parts of the road as segments "road-FROM" that are not linked.
std::shared_ptr<MemorySource> map_of_parts(const LandmarkRoad& road,
                                           const std::vector<AlongRange>& parts);

// Waits until the localizer's map wants are settled.
void wait_for_tiles(Localizer& localizer, double timestamp_s);

}  // namespace milepost::testing
