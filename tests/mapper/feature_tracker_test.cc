#include "mapper/tracklets/feature_tracker.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "mapper/tracklets/motion.h"

namespace milepost {
namespace {

// Points of the world in front of a camera that drives straight ahead, each with a descriptor of
// its own, as a feature extractor would report them.
class World {
 public:
  explicit World(int points) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> lateral(-8, 8);
    std::uniform_real_distribution<double> height(-2, 4);
    std::uniform_real_distribution<double> along(12, 60);
    std::uniform_int_distribution<int> byte(0, 140);
    for (int i = 0; i < points; ++i) {
      Point point{lateral(random), height(random), along(random), {}};
      for (auto& value : point.descriptor) value = static_cast<std::uint8_t>(byte(random));
      points_.push_back(point);
    }
  }

  FeatureSet observe(double along_m) const {
    FeatureSet set;
    for (const Point& point : points_) {
      const double depth_m = point.along_m - along_m;
      if (depth_m < 2) continue;
      set.features.push_back({static_cast<float>(300 + 360 * point.right_m / depth_m),
                              static_cast<float>(250 - 360 * point.up_m / depth_m),
                              static_cast<float>(80 / depth_m)});
      set.descriptors.push_back(point.descriptor);
    }
    return set;
  }

  void make_descriptors_alike() {
    for (Point& point : points_) point.descriptor = points_.front().descriptor;
  }

 private:
  struct Point {
    double right_m, up_m, along_m;
    Descriptor descriptor;
  };
  std::vector<Point> points_;
};

std::vector<Track> follow(FeatureTracker& tracker, const World& world, int frames) {
  std::vector<Track> all;
  for (int k = 0; k < frames; ++k) {
    for (Track& track : tracker.add(world.observe(2.0 * k), 2.0 * k))
      all.push_back(std::move(track));
  }
  for (Track& track : tracker.finish()) all.push_back(std::move(track));
  return all;
}

TEST(FeatureTracker, TracksDistinctFeaturesThroughAllFrames) {
  const World world(60);
  FeatureTracker tracker({}, 600);
  const std::vector<Track> tracks = follow(tracker, world, 5);
  int whole = 0;
  for (const Track& track : tracks) {
    for (const Observation& observation : track)
      EXPECT_EQ(observation.descriptor, track[0].descriptor);
    for (std::size_t m = 1; m < track.size(); ++m) {
      EXPECT_DOUBLE_EQ(track[m].along_m - track[m - 1].along_m, 2.0);
      EXPECT_GT(track[m].feature.scale_px, track[m - 1].feature.scale_px);
    }
    whole += track.size() == 5 ? 1 : 0;
  }
  EXPECT_GE(whole, 40);  // the others leave the search area by their motion near the camera
}

TEST(FeatureTracker, AnAmbiguousDescriptorStartsNoTrack) {
  World world(60);
  world.make_descriptors_alike();
  FeatureTracker tracker({}, 600);
  EXPECT_THAT(follow(tracker, world, 5), ::testing::IsEmpty());
}

TEST(FeatureTracker, AFeatureBelongsToOneTrackAtMost) {
  const World world(60);
  FeatureSet first = world.observe(0);
  FeatureTracker tracker({}, 600);
  EXPECT_THAT(tracker.add(first, 0), ::testing::IsEmpty());
  // A second feature with the same descriptor nearby: only one of the two can be continued.
  first.features.push_back(first.features[0]);
  first.features.back().x_px += 3;
  first.descriptors.push_back(first.descriptors[0]);
  FeatureTracker twice({}, 600);
  (void)twice.add(first, 0);
  for (int k = 1; k < 5; ++k) (void)twice.add(world.observe(2.0 * k), 2.0 * k);
  int followed = 0;
  for (const Track& track : twice.finish()) {
    followed += track[0].descriptor == first.descriptors[0] ? 1 : 0;
  }
  EXPECT_LE(followed, 1);
}

TEST(FeatureTracker, DropsShortTracksSilently) {
  const World world(60);
  FeatureTracker tracker({}, 600);
  (void)tracker.add(world.observe(0), 0);
  (void)tracker.add(world.observe(2), 2);
  EXPECT_THAT(tracker.add(FeatureSet{}, 4), ::testing::IsEmpty());
  EXPECT_THAT(tracker.finish(), ::testing::IsEmpty());
}

TEST(PredictPosition, IsExactUnderStraightMotion) {
  const double right_m = 3;
  const double ahead_m = 30;
  Track track;
  for (const double along_m : {0.0, 2.0}) {
    const double depth_m = ahead_m - along_m;
    Observation observation;
    observation.along_m = along_m;
    observation.feature = {static_cast<float>(360 * right_m / depth_m), 0,
                           static_cast<float>(80 / depth_m)};
    track.push_back(observation);
  }
  const PredictedPosition predicted = predict_position(track, 4.0);
  EXPECT_NEAR(predicted.x_px, 360 * right_m / (ahead_m - 4), 0.1);
  EXPECT_NEAR(predicted.motion_px, 360 * right_m / 26 - 360 * right_m / 28, 0.1);
}

}  // namespace
}  // namespace milepost
