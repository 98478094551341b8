#include "client/evaluate/baselines/warping.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace milepost {
namespace {

constexpr double kMaxStepM = 5;

struct Case {
  std::vector<double> along_m;             // of the map's frames
  std::vector<std::vector<double>> costs;  // by query frame, then by frame of the map
};

Case random_case(unsigned seed, std::size_t queries, std::size_t frames) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> cost(0, 1);
  std::uniform_real_distribution<double> spacing_m(0.5, 4);
  Case c;
  double along_m = 10;
  for (std::size_t j = 0; j < frames; ++j) c.along_m.push_back(along_m += spacing_m(random));
  c.costs.resize(queries);
  for (auto& row : c.costs) {
    for (std::size_t j = 0; j < frames; ++j) row.push_back(cost(random));
  }
  return c;
}

// The least cost of all paths that end in query frame i and the map's frame j, by exhaustive
// search.
double by_enumeration(const Case& c, std::size_t i, std::size_t j) {
  if (i == 0) return c.costs[0][j];
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t before = 0; before <= j; ++before) {
    if (c.along_m[j] - c.along_m[before] > kMaxStepM) continue;
    least = std::min(least, by_enumeration(c, i - 1, before));
  }
  return least + c.costs[i][j];
}

std::vector<FrameCost> costs_of(const Case& c, std::size_t i) {
  std::vector<FrameCost> costs;
  for (std::size_t j = 0; j < c.along_m.size(); ++j) {
    costs.push_back({c.along_m[j], c.costs[i][j]});
  }
  return costs;
}

TEST(Warping, IsTheBestOfAllPaths) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Case c = random_case(seed, 6, 7);
    WarpRow row = first_row(costs_of(c, 0));
    for (std::size_t i = 0; i < c.costs.size(); ++i) {
      if (i > 0) row = next_row(row, costs_of(c, i), kMaxStepM);
      ASSERT_EQ(row.size(), c.along_m.size());
      for (std::size_t j = 0; j < row.size(); ++j) {
        EXPECT_EQ(row[j].along_m, c.along_m[j]);
        EXPECT_NEAR(row[j].cost, by_enumeration(c, i, j), 1e-12);
      }
    }
  }
}

TEST(Warping, GoesForwardOnlyAndNoFartherThanAStep) {
  const WarpRow before = {{10, 3}, {14, 0}, {18, 5}};
  const WarpRow row = next_row(before, {{8, 0}, {10, 0}, {12, 0}, {19, 0}, {24, 0}}, kMaxStepM);
  ASSERT_EQ(row.size(), 3U);  // no path leads to 8 m, nor as far as 24 m
  EXPECT_EQ(row[0].along_m, 10);
  EXPECT_EQ(row[0].cost, 3);
  EXPECT_EQ(row[1].along_m, 12);
  EXPECT_EQ(row[1].cost, 3);
  EXPECT_EQ(row[2].along_m, 19);
  EXPECT_EQ(row[2].cost, 0);  // from 14 m, 5 m back
}

// A vehicle that halts and then drives twice as fast: noisy costs, smallest at the truth.
TEST(Warping, FollowsAVehicleThatHaltsAndSpeedsUp) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> noise(0, 0.3);
  const double steps_m[] = {2, 2, 0, 0, 0, 4, 4, 4, 2, 2};
  double truth_m = 20;
  WarpRow row;
  for (const double step_m : steps_m) {
    truth_m += step_m;
    std::vector<FrameCost> costs;
    for (double along_m = 0; along_m < 80; along_m += 2) {
      costs.push_back({along_m, std::min(1.0, std::abs(along_m - truth_m) / 10) + noise(random)});
    }
    row = row.empty() ? first_row(costs) : next_row(row, costs, kMaxStepM);
  }
  EXPECT_NEAR(best_end(row).along_m, truth_m, 2);
}

TEST(Warping, TheFirstOfEqualEndsIsTheBest) {
  EXPECT_EQ(best_end({{1, 2}, {2, 1}, {3, 1}}).along_m, 2);
}

}  // namespace
}  // namespace milepost
