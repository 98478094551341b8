#include "tests/simulator/town.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <opencv2/core.hpp>

#include "tests/simulator/lots.h"
#include "tests/simulator/runs.h"

namespace milepost::simulator {
namespace {

TEST(Network, ARouteNeverComesBackToItself) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Network network = make_network(seed);
    for (const RunPlan& run : make_runs(network, seed, 10000)) {
      if (run.spacing_m == 0) continue;
      const Path path = path_of(network, run);
      for (double a = run.motion.from_m; a < run.motion.to_m; a += 2) {
        for (double b = a + 40; b < run.motion.to_m; b += 2) {
          const cv::Vec2d apart = path.position_at({a, kLaneM}) - path.position_at({b, kLaneM});
          ASSERT_GT(cv::norm(apart), 10) << run.name << " at " << a << " and " << b;
        }
      }
    }
  }
}

TEST(Network, RoutesStayOnCarriageways) {
  const Network network = make_network(1);
  for (const RunPlan& run : make_runs(network, 1, 10000)) {
    const Path path = path_of(network, run);
    for (double along = run.motion.from_m; along < run.motion.to_m; along += 1) {
      const cv::Vec2d at = path.position_at({along, kLaneM});
      const bool is_on_road =
          std::any_of(network.roads.begin(), network.roads.end(), [&](const Road& road) {
            return std::abs(road.path.place_of(at).lateral_m) < road.half_width_m;
          });
      // Corners are rounded by up to a few metres inside a junction.
      double nearest = 1e9;
      for (const Road& road : network.roads) {
        nearest = std::min(nearest, std::abs(road.path.place_of(at).lateral_m) - road.half_width_m);
      }
      EXPECT_TRUE(is_on_road || nearest < 2) << run.route << " at " << along;
    }
  }
}

TEST(Network, HasARoadOverAHill) {
  const Network network = make_network(1);
  const Path& path = network.route("town-hill")->path;
  double lowest = 1e9, highest = -1e9, steepest = 0;
  for (double along = 8; along < 318; along += 2) {
    const double height = network.terrain.height_m(path.position_at({along, 0}));
    const double next = network.terrain.height_m(path.position_at({along + 2, 0}));
    lowest = std::min(lowest, height);
    highest = std::max(highest, height);
    steepest = std::max(steepest, std::abs(next - height) / 2);
  }
  EXPECT_GT(highest - lowest, 8);
  EXPECT_GT(steepest, 0.06);
  EXPECT_LT(steepest, 0.14);
}

TEST(Buildings, StandClearOfRoadsAndOfEachOther) {
  const Network network = make_network(4);
  const auto buildings = make_buildings(network, 4);
  EXPECT_GT(buildings.size(), 150U);
  for (std::size_t i = 0; i < buildings.size(); ++i) {
    for (const cv::Vec2d& corner : buildings[i].footprint) {
      EXPECT_GT(clearance_m(network, corner), -0.1);
    }
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_FALSE(overlaps(buildings[i].footprint, buildings[j].footprint)) << i << " " << j;
    }
  }
}

TEST(Buildings, AreAsTallAsTheirStreet) {
  const Network network = make_network(1);
  double canyon = 0, avenue = 0;
  int canyons = 0, avenues = 0;
  for (const Building& building : make_buildings(network, 1)) {
    if (building.frontage == Frontage::canyon) canyon += building.height_m(), ++canyons;
    if (building.frontage == Frontage::avenue) avenue += building.height_m(), ++avenues;
  }
  EXPECT_GT(canyons, 20);
  EXPECT_GT(avenues, 10);
  EXPECT_GT(canyon / canyons, avenue / avenues + 4);
}

TEST(Town, AnotherSeedGivesAnotherTown) {
  const Town one = make_town(1);
  const Town again = make_town(1);
  const Town other = make_town(2);
  ASSERT_EQ(one.scene.surfaces.size(), again.scene.surfaces.size());
  for (std::size_t i = 0; i < one.scene.surfaces.size(); i += 97) {
    EXPECT_EQ(one.scene.surfaces[i].corners, again.scene.surfaces[i].corners);
  }
  EXPECT_NE(one.buildings[0].footprint, other.buildings[0].footprint);
  EXPECT_NE(one.network.terrain.hill_height_m, other.network.terrain.hill_height_m);
}

TEST(Town, NoTwoFrontsLookAlike) {
  const Network network = make_network(1);
  const auto buildings = make_buildings(network, 1);
  std::vector<std::uint64_t> seeds;
  for (const Building& building : buildings) seeds.push_back(building.seed);
  std::sort(seeds.begin(), seeds.end());
  EXPECT_EQ(std::adjacent_find(seeds.begin(), seeds.end()), seeds.end());
}

}  // namespace
}  // namespace milepost::simulator
