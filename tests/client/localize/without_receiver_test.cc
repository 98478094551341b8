// The localizer on what the vehicle's own motion tells: through a gap of the map, after it was
// lost, and in doubt.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/client/localize/road_drive.h"

namespace milepost {
namespace {

using testing::kReceiverSigmaM;
using testing::kStepM;
using testing::kVehicleMps;
using testing::LandmarkRoad;
using testing::RoadPose;

constexpr double kGapFromM = 160;
constexpr double kGapToM = 195;

void roll_on(Localizer& localizer, double timestamp_s) {
  localizer.observe(Odometry{timestamp_s, kVehicleMps, 0});
}

class OwnMotion : public testing::RoadDrive {
 protected:
  using RoadDrive::RoadDrive;

  // Frames that show nothing of the map, for a distance without a receiver; the last one's fix.
  Fix drive_blindly(double by_m) {
    Fix last;
    for (double driven_m = 0; driven_m < by_m; driven_m += kStepM) {
      roll_on(localizer_, time_s_);
      last = fix_of_nothing();
    }
    return last;
  }
};

class AGapOfTheMap : public OwnMotion {
 protected:
  AGapOfTheMap()
      : OwnMotion(
            testing::map_of_parts(road(), {{0, kGapFromM}, {kGapToM, LandmarkRoad::kLengthM}})) {}

  // Drives to the end of the first part, and blindly to the begin of the second.
  Fix drive_through_the_gap() {
    for (double along_m = track(); along_m < kGapFromM; along_m += kStepM) {
      roll_on(localizer_, time_s_);
      fix({along_m, 0, 0});
    }
    return drive_blindly(kGapToM - kGapFromM);
  }
};

TEST_F(AGapOfTheMap, ThePoseIsCarriedOnThroughIt) {
  const Fix carried = drive_through_the_gap();
  EXPECT_EQ(carried.status, FixStatus::off_map);
  EXPECT_FALSE(carried.along_m);
  ASSERT_TRUE(carried.position);
  const double off_m =
      geodesic_distance_m(*carried.position, road().line().point_at(kGapToM - kStepM));
  EXPECT_LT(off_m, 0.5);
  EXPECT_LT(off_m, 3 * carried.sigma_m);
}

TEST_F(AGapOfTheMap, BeyondItItIsTrackedWithinThreeFrames) {
  drive_through_the_gap();
  Fix found;
  for (int frame = 0; frame < 3; ++frame) {
    roll_on(localizer_, time_s_);
    found = fix({kGapToM + frame * kStepM, 0, 0});
  }
  EXPECT_EQ(found.segment, "road-195");
  EXPECT_TRUE(is_right(found, {2 * kStepM, 0, 0})) << name_of(found.status);
}

// What the receiver says already counts: the carried pose is no second witness of the same place.
TEST_F(AGapOfTheMap, NextToAReceiverTheCarriedPoseAddsNothing) {
  drive_through_the_gap();
  const double along_m = kGapToM;
  const FeatureSet seen = road().observe({along_m, 0, 0}, 0, random_);
  Localizer fresh(map_, road().query_camera(), testing::settings_of_a_short_reach());
  std::vector<Fix> fixes;
  for (Localizer* localizer : {&localizer_, &fresh}) {
    roll_on(*localizer, time_s_);
    localizer->observe(GnssFix{time_s_, road().line().point_at(along_m), kReceiverSigmaM});
    testing::wait_for_tiles(*localizer, time_s_);
    const auto fix = localizer->localize(
        {time_s_, [&](const FeatureParameters&) -> const FeatureSet& { return seen; }});
    ASSERT_TRUE(fix.ok()) << fix.error().line();
    fixes.push_back(*fix);
  }
  EXPECT_EQ(fixes[0].status, FixStatus::initializing);
  EXPECT_EQ(fixes[1].status, FixStatus::initializing);
  EXPECT_EQ(fixes[0].sigma_m, fixes[1].sigma_m);
}

TEST_F(OwnMotion, RejectedItIsCarriedOnWithAWideSigmaAndFoundWhereTheMotionLed) {
  double along_m = track();
  constexpr double kBlindM = 60;  // 6 s: longer than a position of a receiver is believed
  const Fix carried = drive_blindly(kBlindM);
  along_m += kBlindM;
  EXPECT_EQ(carried.status, FixStatus::predicted);
  EXPECT_NEAR(carried.along_m.value_or(0), along_m - kStepM, 2);
  EXPECT_GT(carried.sigma_m, 20);  // it may as well be elsewhere
  int frames = 0;
  for (Fix found; !is_right(found, {along_m - kStepM, 0, 0}) && frames < 30; ++frames) {
    roll_on(localizer_, time_s_);
    found = fix({along_m, 0, 0});
    along_m += kStepM;
  }
  EXPECT_LT(frames, 6);
}

TEST_F(OwnMotion, RejectedItIsLostWhereItsMotionIsNotKnown) {
  track();
  Fix last;
  int frames = 0;  // without odometry
  for (; frames < 300 && last.status != FixStatus::lost; ++frames) last = fix_of_nothing();
  EXPECT_LT(frames, 300);
  EXPECT_FALSE(last.along_m);
}

// A vehicle that stands sees nothing new, and a receiver that contradicts brings doubt, which sigma
// tells.
TEST_F(OwnMotion, InDoubtItIsPredictedWithAWideSigma) {
  constexpr double kOffM = 40;
  const double along_m = track();
  int doubted = 0;
  Fix last;
  for (int frame = 0; frame < 300; ++frame) {
    receive(along_m + kOffM);
    last = fix({along_m, 0, 0});
    if (last.status != FixStatus::predicted) continue;
    ++doubted;
    EXPECT_GT(last.sigma_m, kReceiverSigmaM);
  }
  EXPECT_EQ(last.status, FixStatus::predicted);
  EXPECT_GT(last.sigma_m, 0.9 * kOffM);  // up to where the receiver is
  EXPECT_GT(doubted, 10);
}

}  // namespace
}  // namespace milepost
