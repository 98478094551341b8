#include "client/global/orientation_importance.h"

#include <gtest/gtest.h>

#include <numbers>

#include "schema/geo/geodesy.h"

namespace milepost {
namespace {

constexpr double kQuarterTurn = std::numbers::pi / 2;

// Eq. 2 with numbers computed by hand.
TEST(Similarity, FollowsTheLogisticCurveOfEquation2) {
  EXPECT_NEAR(similarity(0), 1 - 1 / (1 + std::exp(10.0)), 1e-12);
  EXPECT_NEAR(similarity(20 * kRadPerDeg), 0.5, 1e-12);
  EXPECT_NEAR(similarity(16 * kRadPerDeg), 0.880797077977882, 1e-9);
  EXPECT_NEAR(similarity(30 * kRadPerDeg), 0.006692850924285, 1e-9);
}

TEST(AngleBetweenOrientations, IgnoresTheirSense) {
  EXPECT_NEAR(angle_between_orientations_rad(0.1, 0.1 + std::numbers::pi), 0, 1e-12);
  EXPECT_NEAR(angle_between_orientations_rad(-3, 3), 2 * std::numbers::pi - 6, 1e-12);
  EXPECT_NEAR(angle_between_orientations_rad(0, kQuarterTurn), kQuarterTurn, 1e-12);
}

// A wall to the north that runs east, and one to the east that runs north.
const RayCastingGrid& corner() {
  static const RayCastingGrid walls({{{-20, 10}, {20, 10}, 0.1}, {{10, -20}, {10, 20}, 0.1}});
  return walls;
}

// A perpendicular wall is visible ahead and a parallel one to the right, over equal parts of the
// view.
std::vector<ViewSection> corner_sections() {
  return {{{-0.3, 0.3}, {kQuarterTurn}}, {{kQuarterTurn - 0.3, kQuarterTurn + 0.3}, {0.0}}};
}

TEST(OrientationImportance, IsOneWhereAllIsAsExpected) {
  EXPECT_GT(orientation_importance({{0, 0}, 0}, corner_sections(), corner(), 60), 0.99);
}

TEST(OrientationImportance, IsZeroWhereNothingIs) {
  EXPECT_LT(orientation_importance({{0, 0}, kQuarterTurn / 2}, corner_sections(), corner(), 60),
            0.01);
  EXPECT_EQ(orientation_importance({{0, 0}, 0}, corner_sections(), corner(), 5), 0);
  EXPECT_EQ(orientation_importance({{0, 0}, 0}, {}, corner(), 60), 0);
}

// Eq. 3: a section counts by its width.
TEST(OrientationImportance, SectionsCountByTheirWidth) {
  const std::vector<ViewSection> sections = {
      {{-0.3, 0.3}, {kQuarterTurn}}, {{kQuarterTurn - 0.1, kQuarterTurn + 0.1}, {kQuarterTurn}}};
  EXPECT_NEAR(orientation_importance({{0, 0}, 0}, sections, corner(), 60), 0.75, 0.01);
}

// Eq. 2: of several orientations at a bearing the one that agrees best counts.
TEST(OrientationImportance, TheBestOfSeveralOrientationsCounts) {
  const std::vector<ViewSection> sections = {{{-0.3, 0.3}, {0.7, kQuarterTurn, 0.1}}};
  EXPECT_GT(orientation_importance({{0, 0}, 0}, sections, corner(), 60), 0.99);
}

// A wide section covers more than one wall.
TEST(OrientationImportance, AWideSectionIsLookedAtInParts) {
  const std::vector<ViewSection> sections = {{{0, kQuarterTurn}, {kQuarterTurn}}};
  EXPECT_NEAR(orientation_importance({{0, 0}, 0}, sections, corner(), 60), 0.5, 0.03);
}

}  // namespace
}  // namespace milepost
