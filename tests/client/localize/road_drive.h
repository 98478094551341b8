// A drive along the road of landmarks with a localizer, frame by frame.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>

#include "client/localize/localizer.h"
#include "tests/client/localize/landmark_road.h"

namespace milepost::testing {

inline constexpr double kStepM = 1;        // between frames ...
inline constexpr double kVehicleMps = 10;  // ... at this speed
inline constexpr double kReceiverSigmaM = 5;

// Features that belong to no landmarks, as many as usual.
inline FeatureSet unknown_road(FeatureSet seen, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> x_px(0, LandmarkRoad::kWidthPx);
  std::uniform_real_distribution<float> y_px(0, LandmarkRoad::kHeightPx);
  for (Feature& feature : seen.features) {
    feature.x_px = x_px(random);
    feature.y_px = y_px(random);
  }
  seen.descriptors = unlike_descriptors(seen.size(), seed);
  return seen;
}

class RoadDrive : public ::testing::Test {
 protected:
  explicit RoadDrive(std::shared_ptr<MemorySource> map = map_of(road())) : map_(std::move(map)) {}

  static const LandmarkRoad& road() { return shared_road(); }

  // The fix of the next frame, taken at this pose.
  Fix fix(const RoadPose& truth) { return fix_of(road().observe(truth, 0, random_)); }

  Fix fix_of(const FeatureSet& set) {
    wait_for_tiles(localizer_, time_s_);
    const auto fix = localizer_.localize(
        {time_s_, [&](const FeatureParameters&) -> const FeatureSet& { return set; }});
    time_s_ += kStepM / kVehicleMps;
    EXPECT_TRUE(fix.ok()) << fix.error().line();
    return fix.ok() ? *fix : Fix();
  }

  // The fix of a frame that shows nothing of the map.
  Fix fix_of_nothing() {
    const auto seed = static_cast<unsigned>(std::lround(10 * time_s_));
    return fix_of(unknown_road(road().observe({100, 0, 0}, 0, random_), seed));
  }

  void receive(double along_m) {
    localizer_.observe({time_s_, road().line().point_at(along_m), kReceiverSigmaM});
  }

  // Tracks from 100 m to the returned arc length, without GNSS.
  double track() {
    receive(102);
    double along_m = 100;
    FixStatus status = FixStatus::initializing;
    for (; along_m < 150; along_m += kStepM) status = fix({along_m, 0, 0}).status;
    EXPECT_EQ(status, FixStatus::tracking);
    return along_m;
  }

  static bool is_right(const Fix& fix, const RoadPose& truth) {
    return fix.status == FixStatus::tracking && std::abs(*fix.along_m - truth.along_m) < 0.2 &&
           std::abs(*fix.lateral_m - truth.lateral_m) < 0.2;
  }

  std::shared_ptr<MemorySource> map_;
  Localizer localizer_{map_, road().query_camera(), settings_of_a_short_reach()};
  double time_s_ = 100;
  std::mt19937 random_{11};
};

}  // namespace milepost::testing
