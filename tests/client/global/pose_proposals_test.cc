#include "client/global/pose_proposals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "client/global/orientation_importance.h"
#include "schema/geo/geodesy.h"

namespace milepost {
namespace {

// Between four walls, with a wall observed ahead at 30 degrees to the heading, proposed poses agree
// with that, unlike most uniform ones.
TEST(PoseProposals, AgreeWithWhatIsSeen) {
  const RayCastingGrid walls({{{0, 0}, {40, 0}, 0.1},
                              {{40, 0}, {40, 40}, 0.1},
                              {{40, 40}, {0, 40}, 0.1},
                              {{0, 40}, {0, 0}, 0.1}});
  const WallObservation seen{{{{-0.1, 0.1}, {std::numbers::pi / 6}}}, {}};
  Random random(2);
  const PlanBox area{{2, 2}, {38, 38}};
  int agree = 0;
  int headings[4] = {0, 0, 0, 0};
  for (const Particle& particle : proposed_particles(400, seen, walls, area, 60, random)) {
    EXPECT_TRUE(area.contains(particle.pose.enu_m));
    EXPECT_DOUBLE_EQ(particle.weight, 1.0 / 400);
    if (orientation_importance(particle.pose, seen.sections, walls, 60) < 0.9) continue;
    ++agree;
    const double turns = particle.pose.heading_rad / (2 * std::numbers::pi);
    ++headings[static_cast<int>((turns - std::floor(turns)) * 4)];
  }
  EXPECT_GT(agree, 230);
  for (const int count : headings) EXPECT_GT(count, 30);
  int agree_by_chance = 0;
  for (const Particle& particle : uniform_particles(400, area, random)) {
    const bool agrees = orientation_importance(particle.pose, seen.sections, walls, 60) >= 0.9;
    agree_by_chance += agrees ? 1 : 0;
  }
  EXPECT_GT(agree, 2 * agree_by_chance);
}

// In a street, the ranges to both sides determine the position across it.
TEST(PoseProposals, LieWhereBeamsEndAtWalls) {
  const RayCastingGrid walls({{{0, -200}, {0, 200}, 0.1}, {{12, -200}, {12, 200}, 0.1}});
  const double left_rad = -0.6;
  const double right_rad = 0.6;
  const WallObservation seen{
      {{{-0.7, -0.5}, {0}}, {{0.5, 0.7}, {0}}},
      {{left_rad, 4 / std::sin(right_rad), 0.1}, {right_rad, 8 / std::sin(right_rad), 0.1}}};
  const PlanBox area{{0.5, -100}, {11.5, 100}};
  Random random(2);
  int fitting = 0;
  for (const Particle& particle : proposed_particles(400, seen, walls, area, 60, random)) {
    const bool looks_north = std::cos(particle.pose.heading_rad) > 0;
    const double across_m = looks_north ? 4 : 8;
    if (std::abs(particle.pose.enu_m.x() - across_m) < 1) ++fitting;
  }
  EXPECT_GT(fitting, 300);  // within 1 m of 11: one in five by chance
}

// Two walls at 70 degrees to each other: an orientation observed to the right is matched there.
TEST(PoseProposals, AgreeWithWhatIsSeenToTheSide) {
  const double azimuth_rad = 70 * kRadPerDeg;
  const RayCastingGrid walls(
      {{{0, -60}, {0, 60}, 0.1}, {{0, -60}, 120 * direction_of(azimuth_rad), 0.1}});
  const WallObservation seen{{{{1.1, 1.3}, {0.4}}}, {}};
  Random random(2);
  int looking = 0;
  int agree = 0;
  for (const Particle& particle :
       proposed_particles(1000, seen, walls, {{2, 0}, {40, 40}}, 60, random)) {
    const double bearing_rad = particle.pose.heading_rad + 1.2;
    if (!walls.first_hit(particle.pose.enu_m, direction_of(bearing_rad), 60)) continue;
    ++looking;
    agree += orientation_importance(particle.pose, seen.sections, walls, 60) > 0.9 ? 1 : 0;
  }
  EXPECT_GT(looking, 300);
  EXPECT_GT(agree, 0.9 * looking);
}

// Orientations are noisy.
TEST(PoseProposals, HeadingsAreSpread) {
  const RayCastingGrid walls({{{-500, 10}, {500, 10}, 0.1}, {{-500, -1}, {500, -1}, 0.1}});
  const WallObservation seen{{{{-0.1, 0.1}, {std::numbers::pi / 2}}}, {}};
  Random random(2);
  std::vector<double> off_rad;
  off_rad.reserve(401);
  for (const Particle& particle :
       proposed_particles(401, seen, walls, {{-9, 0}, {9, 9}}, 60, random)) {
    off_rad.push_back(std::abs(std::sin(particle.pose.heading_rad)));
  }
  std::ranges::sort(off_rad);
  EXPECT_GT(off_rad[200], 0.5 * kRadPerDeg);
  EXPECT_LT(off_rad[200], 5 * kRadPerDeg);
}

// In a corner, one beam determines the distance to one wall, the other to the other wall.
TEST(PoseProposals, TwoBeamsDetermineAPosition) {
  const RayCastingGrid walls({{{0, -200}, {0, 200}, 0.1}, {{-200, 100}, {200, 100}, 0.1}});
  const WallObservation seen{{{{-0.9, -0.7}, {0}}, {{-0.1, 0.1}, {std::numbers::pi / 2}}},
                             {{-0.8, 7 / std::sin(0.8), 0.1}, {0, 30, 0.1}}};
  Random random(2);
  int fitting = 0;
  for (const Particle& particle :
       proposed_particles(400, seen, walls, {{1, 60}, {40, 99}}, 60, random)) {
    fitting += (particle.pose.enu_m - Eigen::Vector2d(7, 70)).norm() < 3 ? 1 : 0;
  }
  EXPECT_GT(fitting, 35);  // by one beam alone, or by chance, a few
}

TEST(PoseProposals, GoThroughNoWallsAndStayInTheArea) {
  const WallObservation seen{{{{-0.1, 0.1}, {std::numbers::pi / 2}}}, {{0, 20, 0.1}}};
  Random random(2);
  const RayCastingGrid one({{{-500, 6}, {500, 6}, 0.1}});
  for (const Particle& particle :
       proposed_particles(400, seen, one, {{-9, 1}, {9, 5}}, 60, random)) {
    EXPECT_GE(particle.pose.enu_m.y(), 1);
  }
  // Between two walls no pose is 20 m away from the wall in view.
  const RayCastingGrid two({{{-500, 6}, {500, 6}, 0.1}, {{-500, 0}, {500, 0}, 0.1}});
  int between = 0;
  for (const Particle& particle :
       proposed_particles(1100, seen, two, {{-9, -30}, {9, 36}}, 60, random)) {
    between += particle.pose.enu_m.y() > 0 && particle.pose.enu_m.y() < 6 ? 1 : 0;
  }
  EXPECT_NEAR(between, 100, 30);
}

TEST(PoseProposals, StayInTheAreaAndBeforeTheWalls) {
  const RayCastingGrid walls({{{0, 0}, {40, 0}, 0.1}, {{0, 6}, {40, 6}, 0.1}});
  const WallObservation seen{{{{-0.1, 0.1}, {std::numbers::pi / 2}}}, {{0, 20, 0.1}}};
  const PlanBox area{{2, 1}, {38, 5}};
  Random random(2);
  for (const Particle& particle : proposed_particles(400, seen, walls, area, 60, random)) {
    EXPECT_TRUE(area.contains(particle.pose.enu_m));
  }
}

TEST(PoseProposals, LookAnywhereWhereThereIsNoWall) {
  const RayCastingGrid walls({{{1000, 0}, {1000, 40}, 0.1}});
  const WallObservation seen{{{{-0.1, 0.1}, {0.5}}}, {}};
  Random random(2);
  int north = 0;
  for (const Particle& particle :
       proposed_particles(400, seen, walls, {{0, 0}, {9, 9}}, 60, random))
    north += std::cos(particle.pose.heading_rad) > 0 ? 1 : 0;
  EXPECT_NEAR(north, 200, 40);
}

}  // namespace
}  // namespace milepost
