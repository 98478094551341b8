#include "tests/simulator/centreline.h"

#include <gtest/gtest.h>

#include <cmath>

namespace milepost::simulator {
namespace {

class Centrelines : public ::testing::TestWithParam<double> {};

TEST_P(Centrelines, PlacesAreFoundAgain) {
  const Centreline line(30, GetParam());
  for (const double along_m : {-20.0, 0.0, 0.5, 100.0, 250.0}) {
    for (const double lateral_m : {-8.0, 0.0, 1.75, 8.0}) {
      const StreetPlace place = line.place_of(line.position_at({along_m, lateral_m}));
      EXPECT_NEAR(place.along_m, along_m, 1e-6);
      EXPECT_NEAR(place.lateral_m, lateral_m, 1e-6);
    }
  }
}

TEST_P(Centrelines, AreMeasuredByArcLengthAlongTheirHeading) {
  const Centreline line(30, GetParam());
  constexpr double kStepM = 1e-3;
  constexpr double kRadPerDeg = 0.017453292519943295;
  for (const double along_m : {0.0, 60.0, 200.0}) {
    const cv::Vec2d step =
        line.position_at({along_m + kStepM, 0}) - line.position_at({along_m - kStepM, 0});
    const double heading = line.heading_deg_at(along_m) * kRadPerDeg;
    EXPECT_NEAR(step[0] / (2 * kStepM), std::sin(heading), 1e-6);
    EXPECT_NEAR(step[1] / (2 * kStepM), std::cos(heading), 1e-6);
  }
}

INSTANTIATE_TEST_SUITE_P(StraightLeftAndRight, Centrelines,
                         ::testing::Values(0.0, -1.0 / 300, 1.0 / 900));

TEST(Centreline, TurnsRightWithPositiveCurvature) {
  const Centreline line(0, 1.0 / 100);
  EXPECT_GT(line.position_at({50, 0})[0], 10);
  EXPECT_GT(line.heading_deg_at(50), 28);
}

TEST(Centreline, LateralIsPositiveToTheRight) {
  EXPECT_NEAR(Centreline(0, 0).position_at({10, 2})[0], 2, 1e-12);
  EXPECT_NEAR(Centreline(90, 0).position_at({10, 2})[1], -2, 1e-12);
}

}  // namespace
}  // namespace milepost::simulator
