// A road through landmarks as a map, and what a camera that drives there sees.
#pragma once

#include <memory>
#include <random>

#include "client/fetch/map_source.h"
#include "client/fetch/nearby.h"
#include "client/localize/localizer.h"
#include "schema/feature/codebook.h"
#include "schema/geo/camera_pose.h"
#include "schema/geo/pinhole.h"
#include "schema/geo/route_line.h"
#include "schema/tile/landmark.h"
#include "tests/client/fetch/memory_source.h"
#include "tests/support/descriptors.h"

namespace milepost::testing {

// Where a vehicle is on the road.
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
  const Codebook& codebook() const { return codebook_; }
  SegmentDescription description() const;
  std::vector<LandmarkTile> tiles() const;
  Camera query_camera() const;

  // Of the direction of travel, clockwise from north.
  double course_deg(const RoadPose& at) const;
  // What a camera sees whose mounting is turned by `mounting_deg` clockwise: pixels within 0.5 px
  // (one sigma), scales within 5 %.
  FeatureSet seen_from(const RoadPose& at, double mounting_deg, std::mt19937& random) const;

 private:
  struct Thing {
    GeoPoint position;
    double along_m = 0;  // of the road beside it
    double size_m = 0;
    Descriptor descriptor{};
  };

  RouteLine line_;
  std::vector<Thing> things_;
  Codebook codebook_;
};

// The road, made once for all tests.
const LandmarkRoad& shared_road();

// With a map beside which little is wanted, and which is asked again soon after it failed.
LocalizerSettings settings_of_a_short_reach();

// The map of the road.
std::shared_ptr<MemorySource> map_of(const LandmarkRoad& road);

// Waits until the localizer has what it wants of the map, or was refused it.
void wait_for_tiles(Localizer& localizer, double timestamp_s);

}  // namespace milepost::testing
