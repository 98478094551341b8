#include "mapper/fusion/tie.h"

#include <gtest/gtest.h>

#include "tests/mapper/fusion/made_up_landmarks.h"

namespace milepost {
namespace {

using testing::MadeUpLandmarks;
using testing::MadeUpStreet;

const LocalFrame& local() {
  static const LocalFrame frame(MadeUpStreet::geo_of(Eigen::Vector3d::Zero()));
  return frame;
}

TEST(Tie, IsTheDifferenceOfTwoDrivesPositions) {
  MadeUpLandmarks road(80);
  const Eigen::Vector3d a_off(0.3, -0.2, 0.1);
  const Eigen::Vector3d b_off(-0.9, 0.5, -0.4);
  const auto tie = tie_of(road.mapped(0, a_off), road.mapped(1, b_off), local(), {});
  ASSERT_TRUE(tie);
  EXPECT_LT((tie->enu_m - (b_off - a_off)).norm(), 0.02);
  EXPECT_NEAR(tie->a.along_m, 110, 3);
  EXPECT_NEAR(tie->b.along_m, tie->a.along_m, 1e-9);
  // At least what all matches have in common, and not much more.
  const double least_m2 = TieSettings().tie_sigma_m * TieSettings().tie_sigma_m;
  EXPECT_GE(tie->covariance_m2(0, 0), least_m2);
  EXPECT_LT(tie->covariance_m2(0, 0), least_m2 + 0.008 * 0.008);
}

TEST(Tie, WrongMatchesDoNotPull) {
  MadeUpLandmarks road(80);
  auto a = road.mapped(0, {0, 0, 0});
  for (std::size_t i = 0; i < 40; ++i)  // half have moved
    a[i].landmark.position = MadeUpStreet::geo_of(
        road.features()[i].enu_m + Eigen::Vector3d(1.5, 0.03 * static_cast<double>(i), 0));
  const auto tie = tie_of(a, road.mapped(1, {0.1, 0, 0}), local(), {});
  ASSERT_TRUE(tie);
  EXPECT_LT((tie->enu_m - Eigen::Vector3d(0.1, 0, 0)).norm(), 0.03);
}

TEST(Tie, LandmarksOfOtherFeaturesTieNothing) {
  MadeUpLandmarks road(80);
  EXPECT_FALSE(
      tie_of(road.mapped(0, {0, 0, 0}), road.mapped(1, {0, 0, 0}, 0.02, 1000), local(), {}));
}

TEST(Tie, TooFewTieNothing) {
  MadeUpLandmarks road(8);
  EXPECT_FALSE(tie_of(road.mapped(0, {0, 0, 0}), road.mapped(1, {0, 0, 0}), local(), {}));
  EXPECT_FALSE(tie_of({}, {}, local(), {}));
}

TEST(Tie, FartherApartThanPositionsCanBeTiesNothing) {
  MadeUpLandmarks road(80);
  EXPECT_FALSE(tie_of(road.mapped(0, {0, 0, 0}), road.mapped(1, {9, 0, 0}), local(), {}));
}

TEST(Tie, InexactLandmarksDoNotCount) {
  MadeUpLandmarks road(80);
  auto a = road.mapped(0, {0, 0, 0});
  for (PassLandmark& each : a) each.landmark.depth_sigma_m = 5;
  EXPECT_FALSE(tie_of(a, road.mapped(1, {0, 0, 0}), local(), {}));
}

}  // namespace
}  // namespace milepost
