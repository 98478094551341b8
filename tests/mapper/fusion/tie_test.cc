#include "mapper/fusion/tie.h"

#include <gtest/gtest.h>

#include "tests/mapper/fusion/made_up_landmarks.h"

namespace milepost {
namespace {

using testing::MadeUpLandmarks;
using testing::MadeUpStreet;

// On a road that leads north.
const RoadPlace& here() {
  static const RoadPlace place{LocalFrame(MadeUpStreet::geo_of(Eigen::Vector3d::Zero()))};
  return place;
}

Eigen::Vector3d shift_m(const Tie& tie) { return tie.difference.head<3>(); }

TEST(Tie, IsTheDifferenceOfTwoDrivesPositions) {
  MadeUpLandmarks road(80);
  const Eigen::Vector3d a_off(0.3, -0.2, 0.1);
  const Eigen::Vector3d b_off(-0.9, 0.5, -0.4);
  const auto tie = tie_of(road.mapped(0, a_off), road.mapped(1, b_off), here(), {});
  ASSERT_TRUE(tie);
  EXPECT_LT((shift_m(*tie) - (b_off - a_off)).norm(), 0.02);
  EXPECT_NEAR(tie->difference[kRollAxis], 0, 0.001);
  EXPECT_NEAR(tie->a.along_m, 110, 3);
  EXPECT_NEAR(tie->b.along_m, tie->a.along_m, 1e-9);
  // At least what all matches have in common, and not much more.
  const double least_m2 = TieSettings().tie_sigma_m * TieSettings().tie_sigma_m;
  EXPECT_GE(tie->covariance(0, 0), least_m2);
  EXPECT_LT(tie->covariance(0, 0), least_m2 + 0.01 * 0.01);
}

TEST(Tie, TellsRollFromAShift) {
  MadeUpLandmarks road(80);
  constexpr double kRollRad = 0.02;  // a cambered road: 14 cm at 7 m
  auto b = road.mapped(1, {0.2, 0, 0});
  for (PassLandmark& each : b) {
    const EnuPoint is = here().local.enu_from_geo(each.landmark.position);
    const Eigen::Vector3d at(is.east_m, is.north_m, is.up_m);
    each.landmark.position = MadeUpStreet::geo_of(at + kRollRad * here().forward.cross(at));
  }
  const auto tie = tie_of(road.mapped(0, {0, 0, 0}), b, here(), {});
  ASSERT_TRUE(tie);
  EXPECT_LT((shift_m(*tie) - Eigen::Vector3d(0.2, 0, 0)).norm(), 0.02);
  EXPECT_NEAR(tie->difference[kRollAxis], kRollRad, 0.002);
  EXPECT_LT(std::sqrt(tie->covariance(kRollAxis, kRollAxis)), 0.002);
}

TEST(Tie, WrongMatchesDoNotPull) {
  MadeUpLandmarks road(80);
  auto a = road.mapped(0, {0, 0, 0});
  for (std::size_t i = 0; i < 40; ++i)  // half have moved
    a[i].landmark.position = MadeUpStreet::geo_of(
        road.features()[i].enu_m + Eigen::Vector3d(1.5, 0.03 * static_cast<double>(i), 0));
  const auto tie = tie_of(a, road.mapped(1, {0.1, 0, 0}), here(), {});
  ASSERT_TRUE(tie);
  EXPECT_LT((shift_m(*tie) - Eigen::Vector3d(0.1, 0, 0)).norm(), 0.03);
}

TEST(Tie, LandmarksOfOtherFeaturesTieNothing) {
  MadeUpLandmarks road(80);
  EXPECT_FALSE(
      tie_of(road.mapped(0, {0, 0, 0}), road.mapped(1, {0, 0, 0}, 0.02, 1000), here(), {}));
}

TEST(Tie, TooFewTieNothing) {
  MadeUpLandmarks road(8);
  EXPECT_FALSE(tie_of(road.mapped(0, {0, 0, 0}), road.mapped(1, {0, 0, 0}), here(), {}));
  EXPECT_FALSE(tie_of({}, {}, here(), {}));
}

TEST(Tie, FartherApartThanPositionsCanBeTiesNothing) {
  MadeUpLandmarks road(80);
  EXPECT_FALSE(tie_of(road.mapped(0, {0, 0, 0}), road.mapped(1, {9, 0, 0}), here(), {}));
}

TEST(Tie, InexactLandmarksDoNotCount) {
  MadeUpLandmarks road(80);
  auto a = road.mapped(0, {0, 0, 0});
  for (PassLandmark& each : a) each.landmark.depth_sigma_m = 5;
  EXPECT_FALSE(tie_of(a, road.mapped(1, {0, 0, 0}), here(), {}));
}

}  // namespace
}  // namespace milepost
