// A road through landmarks as a map, and what a camera that drives there sees.
#pragma once

#include <memory>
#include <random>

#include "client/fetch/map_source.h"
#include "client/fetch/nearby.h"
#include "client/localize/localizer.h"
#include "schema/feature/codebook.h"
#include "schema/geo/camera_pose.h"
#include "schema/geo/route_line.h"
#include "schema/tile/landmark.h"

namespace milepost::testing {

// Descriptors that do not resemble each other.
std::vector<Descriptor> unlike_descriptors(std::size_t count, unsigned seed);

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
  QueryCamera query_camera() const;

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

// Of the default method, which asks the source itself.
LocalizerSettings settings_without_prefetcher();

// The map of the road; its tiles can be made to fail.
class LandmarkRoadMap : public MapSource {
 public:
  explicit LandmarkRoadMap(const LandmarkRoad& road);

  bool fails = false;  // from now on

  Result<std::vector<TileFrame>> tiles(const MapVersion& version, const std::string& segment,
                                       const std::string& layer, const AlongRange& range) override;
  Result<std::vector<NearbySegment>> segments_near(const GeoPoint& position,
                                                   double radius_m) override;
  Result<std::vector<MapVersion>> maps() override { return std::vector<MapVersion>{}; }
  Result<MapDescription> describe(const MapVersion& version) override;
  Result<SegmentDescription> segment(const MapVersion& version,
                                     const std::string& segment) override;
  Result<std::vector<CellFrame>> cells(const MapVersion& /*version*/, const std::string& /*layer*/,
                                       const Bounds& /*box*/) override {
    return std::vector<CellFrame>{};
  }
  Result<std::uint64_t> layer_bytes(const MapVersion& version, const std::string& segment,
                                    const std::string& layer) override;
  SourceCounters counters() const override { return {}; }

 private:
  struct StoredTile {
    std::uint32_t index = 0;
    AlongRange along;
    Bytes frame;
  };

  SegmentDescription description_;
  std::string layer_parameters_;
  std::vector<KnownLine> lines_;
  std::vector<StoredTile> tiles_;
};

}  // namespace milepost::testing
