#include "client/global/ray_casting_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <Eigen/LU>

#include "client/global/pose2.h"
#include "tests/client/global/plan_rooms.h"

namespace milepost {
namespace {

TEST(RayCastingGrid, TheFirstWallIsMet) {
  const RayCastingGrid index({{{-5, 10}, {5, 10}, 0.1}, {{-5, 20}, {5, 20}, 0.1}});
  const auto hit = index.first_hit({1, 2}, {0, 1}, 50);
  ASSERT_TRUE(hit.has_value());
  EXPECT_DOUBLE_EQ(hit->range_m, 8);
  EXPECT_EQ(hit->wall, 0U);
  EXPECT_FALSE(index.first_hit({1, 2}, {0, 1}, 7.9).has_value());
  EXPECT_FALSE(index.first_hit({6, 2}, {0, 1}, 50).has_value());
  EXPECT_FALSE(index.first_hit({1, 2}, {0, -1}, 50).has_value());
}

TEST(RayCastingGrid, RaysComeInFromOutsideAndStartInside) {
  const RayCastingGrid index({{{-5, 10}, {5, 10}, 0.1}, {{-5, 20}, {5, 20}, 0.1}});
  EXPECT_DOUBLE_EQ(index.first_hit({0, -500}, {0, 1}, 1000)->range_m, 510);
  const auto behind = index.first_hit({0, 15}, {0, 1}, 1000);
  ASSERT_TRUE(behind.has_value());
  EXPECT_DOUBLE_EQ(behind->range_m, 5);
  EXPECT_EQ(behind->wall, 1U);
}

TEST(RayCastingGrid, WithoutWallsNothingIsMet) {
  const RayCastingGrid index({});
  EXPECT_FALSE(index.first_hit({0, 0}, {0, 1}, 100).has_value());
  EXPECT_FALSE(index.is_crossed({-10, -10}, {10, 10}));
  EXPECT_TRUE(index.walls().empty());
}

TEST(RayCastingGrid, AWallWithoutLengthIsLeftOut) {
  EXPECT_EQ(RayCastingGrid({{{1, 1}, {1, 1}, 0.1}, {{0, 0}, {1, 0}, 0.1}}).walls().size(), 1U);
}

// The range to the first wall by exhaustive search.
double range_by_scan(const std::vector<PlanWall>& walls, const Eigen::Vector2d& from,
                     const Eigen::Vector2d& direction) {
  double range = std::numeric_limits<double>::infinity();
  for (const PlanWall& wall : walls) {
    Eigen::Matrix2d sides;
    sides << direction, wall.begin_m - wall.end_m;
    const Eigen::Vector2d at = sides.fullPivLu().solve(wall.begin_m - from);
    if (at.x() >= 0 && at.y() >= 0 && at.y() <= 1) range = std::min(range, at.x());
  }
  return range;
}

TEST(RayCastingGrid, FindsWhatAScanOfAllWallsFinds) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-60, 60);
  std::uniform_real_distribution<double> way(-9, 9);
  std::uniform_real_distribution<double> angle(0, 2 * std::numbers::pi);
  std::vector<PlanWall> walls;
  for (int i = 0; i < 300; ++i) {
    const Eigen::Vector2d begin(place(random), place(random));
    walls.push_back({begin, begin + Eigen::Vector2d(way(random), way(random)), 0.1});
  }
  const RayCastingGrid index(walls);
  int met = 0;
  for (int i = 0; i < 5000; ++i) {
    const Eigen::Vector2d from(1.3 * place(random), 1.3 * place(random));
    const Eigen::Vector2d direction = direction_of(angle(random));
    const double expected_m = range_by_scan(walls, from, direction);
    const auto hit = index.first_hit(from, direction, 40);
    ASSERT_EQ(hit.has_value(), expected_m <= 40) << "ray " << i << ", " << expected_m;
    if (!hit) continue;
    ++met;
    ASSERT_NEAR(hit->range_m, expected_m, 1e-9) << "ray " << i;
  }
  EXPECT_GT(met, 2000);
}

// Along the axes of the grid, on the borders of squares, and beside all walls.
TEST(RayCastingGrid, RaysAlongTheAxesMeetTheirWalls) {
  std::vector<PlanWall> walls;
  testing::add_house(walls, {0, 0}, {40, 24});
  const RayCastingGrid index(walls);
  EXPECT_DOUBLE_EQ(index.first_hit({8, 12}, {0, 1}, 100)->range_m, 12);
  EXPECT_DOUBLE_EQ(index.first_hit({8, 12}, {0, -1}, 100)->range_m, 12);
  EXPECT_DOUBLE_EQ(index.first_hit({8, 12}, {1, 0}, 100)->range_m, 32);
  EXPECT_DOUBLE_EQ(index.first_hit({8, 12}, {-1, 0}, 100)->range_m, 8);
  EXPECT_DOUBLE_EQ(index.first_hit({8, 40}, {0, -1}, 100)->range_m, 16);
  EXPECT_DOUBLE_EQ(index.first_hit({60, 12}, {-1, 0}, 100)->range_m, 20);
  EXPECT_FALSE(index.first_hit({41, -10}, {0, 1}, 100).has_value());
  EXPECT_FALSE(index.first_hit({-10, 25}, {1, 0}, 100).has_value());
  EXPECT_FALSE(index.first_hit({-10, 20}, {0.6, 0.8}, 100).has_value());
}

TEST(RayCastingGrid, AStepThroughAWallCrossesIt) {
  std::vector<PlanWall> walls;
  testing::add_house(walls, {0, 0}, {10, 8});
  const RayCastingGrid index(walls);
  EXPECT_TRUE(index.is_crossed({-1, 4}, {1, 4}));
  EXPECT_TRUE(index.is_crossed({5, 4}, {20, 4}));
  EXPECT_FALSE(index.is_crossed({2, 2}, {8, 6}));
  EXPECT_FALSE(index.is_crossed({-1, -1}, {-1, 20}));
  EXPECT_FALSE(index.is_crossed({3, 3}, {3, 3}));
}

TEST(PlanWall, ItsAzimuthIsClockwiseFromNorth) {
  EXPECT_DOUBLE_EQ((PlanWall{{0, 0}, {3, 0}, 0}).azimuth_rad(), std::numbers::pi / 2);
  EXPECT_DOUBLE_EQ((PlanWall{{0, 0}, {0, 3}, 0}).azimuth_rad(), 0);
}

}  // namespace
}  // namespace milepost
