#include "client/find/pose_proposals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "client/find/orientation_importance.h"

namespace milepost {
namespace {

// Between four walls, where a wall at 30 degrees to the heading is seen ahead, poses agree with
// that: as a uniform one rarely does.
TEST(PoseProposals, AgreeWithWhatIsSeen) {
  const WallIndex walls({{{0, 0}, {40, 0}, 0.1},
                         {{40, 0}, {40, 40}, 0.1},
                         {{40, 40}, {0, 40}, 0.1},
                         {{0, 40}, {0, 0}, 0.1}});
  const WallObservation seen{{{{-0.1, 0.1}, {std::numbers::pi / 6}}}, {}};
  Random random(2);
  const PlanBox area{{2, 2}, {38, 38}};
  int agree = 0;
  int headings[4] = {0, 0, 0, 0};
  for (const Particle& particle : proposed_cloud(400, seen, walls, area, 60, random)) {
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
  for (const Particle& particle : uniform_cloud(400, area, random)) {
    const bool agrees = orientation_importance(particle.pose, seen.sections, walls, 60) >= 0.9;
    agree_by_chance += agrees ? 1 : 0;
  }
  EXPECT_GT(agree, 2 * agree_by_chance);
}

// In a street, what stands to both sides tells the place across it.
TEST(PoseProposals, LieWhereBeamsEndAtWalls) {
  const WallIndex walls({{{0, -200}, {0, 200}, 0.1}, {{12, -200}, {12, 200}, 0.1}});
  const double left_rad = -0.6;
  const double right_rad = 0.6;
  const WallObservation seen{
      {{{-0.7, -0.5}, {0}}, {{0.5, 0.7}, {0}}},
      {{left_rad, 4 / std::sin(right_rad), 0.1}, {right_rad, 8 / std::sin(right_rad), 0.1}}};
  const PlanBox area{{0.5, -100}, {11.5, 100}};
  Random random(2);
  int fitting = 0;
  for (const Particle& particle : proposed_cloud(400, seen, walls, area, 60, random)) {
    const bool looks_north = std::cos(particle.pose.heading_rad) > 0;
    const double across_m = looks_north ? 4 : 8;
    if (std::abs(particle.pose.enu_m.x() - across_m) < 1) ++fitting;
  }
  EXPECT_GT(fitting, 300);  // within 1 m of 11: one in five by chance
}

TEST(PoseProposals, StayInTheAreaAndBeforeTheWalls) {
  const WallIndex walls({{{0, 0}, {40, 0}, 0.1}, {{0, 6}, {40, 6}, 0.1}});
  const WallObservation seen{{{{-0.1, 0.1}, {std::numbers::pi / 2}}}, {{0, 20, 0.1}}};
  const PlanBox area{{2, 1}, {38, 5}};
  Random random(2);
  for (const Particle& particle : proposed_cloud(400, seen, walls, area, 60, random)) {
    EXPECT_TRUE(area.contains(particle.pose.enu_m));
  }
}

TEST(PoseProposals, LookAnywhereWhereThereIsNoWall) {
  const WallIndex walls({{{1000, 0}, {1000, 40}, 0.1}});
  const WallObservation seen{{{{-0.1, 0.1}, {0.5}}}, {}};
  Random random(2);
  int north = 0;
  for (const Particle& particle : proposed_cloud(400, seen, walls, {{0, 0}, {9, 9}}, 60, random))
    north += std::cos(particle.pose.heading_rad) > 0 ? 1 : 0;
  EXPECT_NEAR(north, 200, 40);
}

}  // namespace
}  // namespace milepost
