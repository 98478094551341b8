#include "tests/simulator/path.h"

#include <gtest/gtest.h>

#include <cmath>

namespace milepost::simulator {
namespace {

Path winding() {
  return Path::through({{{0, 0}}, {{0, 100}, 20}, {{80, 150}, 30}, {{80, 300}, 40}, {{200, 300}}});
}

TEST(Path, PlacesAreFoundAgain) {
  for (const Path& path : {winding(), Path::circle({5, -3}, 12)}) {
    for (double along_m = 0.5; along_m < path.length_m(); along_m += 3.1) {
      for (const double lateral_m : {-5.0, 0.0, 1.75, 5.0}) {
        const RoadPlace place = path.place_of(path.position_at({along_m, lateral_m}));
        EXPECT_NEAR(place.along_m, along_m, 1e-6);
        EXPECT_NEAR(place.lateral_m, lateral_m, 1e-6);
      }
    }
  }
}

TEST(Path, IsMeasuredByArcLengthAlongItsHeading) {
  const Path path = winding();
  constexpr double kStepM = 1e-3;
  for (double along_m = 1; along_m < path.length_m() - 1; along_m += 2.3) {
    const cv::Vec2d step =
        path.position_at({along_m + kStepM, 0}) - path.position_at({along_m - kStepM, 0});
    const double heading = path.heading_rad_at(along_m);
    EXPECT_NEAR(step[0] / (2 * kStepM), std::sin(heading), 1e-4) << along_m;
    EXPECT_NEAR(step[1] / (2 * kStepM), std::cos(heading), 1e-4) << along_m;
  }
}

TEST(Path, HasNeitherGapsNorCorners) {
  const Path southwards = Path::through({{{0, 0}}, {{50, -100}, 20}, {{0, -200}}});
  constexpr double kStepM = 0.01;
  for (const Path& path : {winding(), southwards, Path::circle({5, -3}, 12)}) {
    for (double along_m = 0; along_m + kStepM < path.length_m(); along_m += kStepM) {
      const cv::Vec2d step =
          path.position_at({along_m + kStepM, 0}) - path.position_at({along_m, 0});
      ASSERT_NEAR(cv::norm(step), kStepM, 1e-6) << along_m;
      const double turn = path.heading_rad_at(along_m + kStepM) - path.heading_rad_at(along_m);
      ASSERT_NEAR(std::sin(turn), 0, 1.1 * kStepM / 12) << along_m;
    }
  }
}

TEST(Path, ACircleRunsCounterClockwiseFromItsEasternmostPoint) {
  const Path path = Path::circle({5, -3}, 12);
  EXPECT_NEAR(path.length_m(), 2 * CV_PI * 12, 1e-9);
  EXPECT_NEAR(cv::norm(path.position_at({0, 0}) - cv::Vec2d(17, -3)), 0, 1e-9);
  EXPECT_NEAR(cv::norm(path.position_at({path.length_m() / 4, 0}) - cv::Vec2d(5, 9)), 0, 1e-9);
}

TEST(Path, ShiftedKeepsItsDistance) {
  const Path path = winding();
  for (const double lateral_m : {-6.0, 3.5}) {
    const Path beside = path.shifted(lateral_m);
    for (double along_m = 0; along_m < beside.length_m(); along_m += 3) {
      EXPECT_NEAR(path.place_of(beside.position_at({along_m, 0})).lateral_m, lateral_m, 1e-6);
    }
  }
}

TEST(Path, PartsChainToTheWhole) {
  const Path path = winding();
  const Path whole =
      Path::chain({path.part(0, 91), path.part(91, 91.5), path.part(91.5, path.length_m())});
  EXPECT_NEAR(whole.length_m(), path.length_m(), 1e-9);
  for (double along_m = 0; along_m < path.length_m(); along_m += 7) {
    EXPECT_NEAR(cv::norm(whole.position_at({along_m, 0.5}) - path.position_at({along_m, 0.5})), 0,
                1e-9);
  }
}

TEST(Path, JoinsTwoPlacesInTheirDirections) {
  const Directed from{{3, 5}, 0.3};
  for (const Directed& to :
       {Directed{{20, 30}, 1.2}, Directed{{-9, 20}, -1.3},
        Directed{{3 + 40 * std::sin(0.3), 5 + 40 * std::cos(0.3)}, 0.3}, Directed{{12, 40}, 0.3}}) {
    const Path path = Path::joining(from, to);
    EXPECT_NEAR(cv::norm(path.start().at - from.at), 0, 1e-6);
    EXPECT_NEAR(std::remainder(path.start().heading_rad - from.heading_rad, 2 * CV_PI), 0, 1e-6);
    EXPECT_NEAR(cv::norm(path.end().at - to.at), 0, 1e-6);
    EXPECT_NEAR(std::remainder(path.end().heading_rad - to.heading_rad, 2 * CV_PI), 0, 1e-6);
    EXPECT_LT(path.length_m(), 1.6 * cv::norm(to.at - from.at));
  }
}

TEST(Path, ReversedIsTheSameLineInTheOtherDirection) {
  const Path path = winding();
  const Path back = path.reversed();
  ASSERT_NEAR(back.length_m(), path.length_m(), 1e-9);
  for (double along_m = 0.5; along_m < path.length_m(); along_m += 3.1) {
    const double back_m = path.length_m() - along_m;
    const cv::Vec2d apart = back.position_at({back_m, -2}) - path.position_at({along_m, 2});
    EXPECT_NEAR(cv::norm(apart), 0, 1e-9) << along_m;
    const double turn = back.heading_rad_at(back_m) - path.heading_rad_at(along_m);
    EXPECT_NEAR(std::cos(turn), -1, 1e-9) << along_m;
    EXPECT_NEAR(back.curvature_per_m_at(back_m), -path.curvature_per_m_at(along_m), 1e-9);
  }
}

TEST(Path, GoesOnBeforeItsStartAndAfterItsEnd) {
  const Path path = winding();
  EXPECT_NEAR(cv::norm(path.position_at({-5, 0}) - cv::Vec2d(0, -5)), 0, 1e-9);
  EXPECT_NEAR(cv::norm(path.position_at({path.length_m() + 5, 0}) - cv::Vec2d(205, 300)), 0, 1e-9);
}

TEST(Path, RoundsItsBendsAndEndsWhereItWasDrawnTo) {
  const Path path = winding();
  const cv::Vec2d end = path.position_at({path.length_m(), 0});
  EXPECT_NEAR(end[0], 200, 1e-9);
  EXPECT_NEAR(end[1], 300, 1e-9);
  EXPECT_GT(std::abs(path.place_of({0, 100}).lateral_m), 1);  // the corner is cut
  EXPECT_GT(path.curvature_per_m_at(path.place_of({0, 100}).along_m), 1.0 / 21);  // to the right
}

TEST(Path, LateralIsPositiveToTheRight) {
  const Path path = Path::through({{{0, 0}}, {{100, 0}}});  // eastwards
  EXPECT_NEAR(path.position_at({10, 2})[1], -2, 1e-12);
  EXPECT_NEAR(path.place_of({10, -2}).lateral_m, 2, 1e-12);
}

}  // namespace
}  // namespace milepost::simulator
