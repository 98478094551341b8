// The localizer with landmarks when its belief is wrong: it reports this, or nothing.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/client/localize/road_drive.h"

namespace milepost {
namespace {

using testing::kReceiverSigmaM;
using testing::kStepM;
using testing::LandmarkRoad;
using testing::RoadPose;

class RightOrSilent : public testing::RoadDrive {
 protected:
  // Whether the horizontal error is more than a metre and five sigmas.
  static bool is_confidently_wrong(const Fix& fix, const RoadPose& truth) {
    if (!fix.along_m) return false;
    const double off_m = std::hypot(*fix.along_m - truth.along_m, *fix.lateral_m - truth.lateral_m);
    return off_m > std::max(1.0, 5 * std::hypot(fix.sigma_m, *fix.lateral_sigma_m));
  }
};

// The error introduced into the belief during the drive.
struct Push {
  double along_m = 0;
  double lateral_m = 0;
};

class PushedAway : public RightOrSilent, public ::testing::WithParamInterface<Push> {};

TEST_P(PushedAway, ItIsLostWithinFiveFramesAndClaimsNothingMeanwhile) {
  RoadPose truth{track() + GetParam().along_m, GetParam().lateral_m, 0};
  Fix last;
  for (int frame = 0; frame < 5; ++frame) {
    last = fix(truth);
    EXPECT_FALSE(is_confidently_wrong(last, truth))
        << frame << ": " << last.along_m.value_or(-1) << " at " << last.sigma_m;
    truth.along_m += kStepM;
  }
  truth.along_m -= kStepM;
  EXPECT_TRUE(is_right(last, truth) || last.status == FixStatus::lost ||
              last.status == FixStatus::initializing)
      << name_of(last.status);
}

TEST_P(PushedAway, TheReceiverBringsItBack) {
  RoadPose truth{track() + GetParam().along_m, GetParam().lateral_m, 0};
  int frames = 0;
  for (Fix found; !is_right(found, truth) && frames < 30; ++frames) {
    truth.along_m += kStepM;
    receive(truth.along_m + 3);
    found = fix(truth);
    EXPECT_FALSE(is_confidently_wrong(found, truth)) << frames;
  }
  EXPECT_LT(frames, 10);
}

INSTANTIATE_TEST_SUITE_P(ArcLengthAndLateral, PushedAway,
                         ::testing::Values(Push{5, 0}, Push{10, 0}, Push{20, 0}, Push{30, 0},
                                           Push{-10, 0}, Push{0, 3}, Push{0, -8}));

TEST_F(RightOrSilent, OnAnotherRoadThanTheMapsItClaimsNothing) {
  for (int frame = 0; frame < 40; ++frame) {
    receive(100 + frame);
    const RoadPose at{100.0 + frame, 0, 0};
    const Fix nowhere = fix_of(testing::unknown_road(road().observe(at, 0, random_), 1000 + frame));
    EXPECT_NE(nowhere.status, FixStatus::tracking);
    EXPECT_FALSE(nowhere.along_m) << frame;
  }
}

TEST_F(RightOrSilent, OffOnToAnUnknownRoadItMayBeElsewhere) {
  double along_m = track();
  Fix fix;
  for (int frame = 0; frame < 5; ++frame, along_m += kStepM) {
    receive(along_m);
    fix = fix_of(testing::unknown_road(road().observe({along_m, 0, 0}, 0, random_), 1000 + frame));
    EXPECT_NE(fix.status, FixStatus::tracking);
  }
  EXPECT_EQ(fix.status, FixStatus::predicted);
  EXPECT_GT(fix.sigma_m, 0.9 * kReceiverSigmaM);
}

TEST_F(RightOrSilent, OneFrameClaimsNothing) {
  receive(102);
  const Fix first = fix({100, 0, 0});
  EXPECT_EQ(first.status, FixStatus::initializing);
  EXPECT_NEAR(*first.along_m, 100, 0.2);
  EXPECT_GT(first.sigma_m, 0.3);  // of all hypotheses
  EXPECT_EQ(fix({101, 0, 0}).status, FixStatus::tracking);
}

TEST_F(RightOrSilent, ComingFromBeyondTheMapItIsOffUntilTheMapIsSeen) {
  for (double before_m = 60; before_m > 25; before_m -= kStepM) {
    const GeoPoint start = road().line().point_at(0);
    localizer_.observe({time_s_,
                        {start.latitude_deg - before_m / 111229, start.longitude_deg, 0},
                        kReceiverSigmaM});
    EXPECT_EQ(fix_of(testing::unknown_road(road().observe({5, 0, 0}, 0, random_), 7)).status,
              FixStatus::off_map);
  }
  int frames = 0;
  FixStatus status = FixStatus::off_map;
  for (double along_m = 1; status != FixStatus::tracking && frames < 10; along_m += kStepM) {
    receive(along_m);
    status = fix({along_m, 0, 0}).status;
    ++frames;
  }
  EXPECT_LE(frames, 3);
}

TEST_F(RightOrSilent, LeavingTheMapItIsOffAndStaysSo) {
  receive(570);
  double along_m = 570;
  for (; along_m < 602; along_m += kStepM) fix({along_m, 0, 0});
  Fix fix;
  for (int frame = 0; frame < 30; ++frame) {
    receive(LandmarkRoad::kLengthM);  // GNSS lags
    fix = fix_of(testing::unknown_road(road().observe({590, 0, 0}, 0, random_), 1000 + frame));
    EXPECT_NE(fix.status, FixStatus::tracking) << frame;
  }
  EXPECT_EQ(fix.status, FixStatus::off_map);
}

}  // namespace
}  // namespace milepost
