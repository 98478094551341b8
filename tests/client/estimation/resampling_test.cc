#include "client/estimation/resampling.h"

#include <gtest/gtest.h>

#include <vector>

namespace milepost {
namespace {

std::vector<int> drawn(const std::vector<double>& weights, double total, std::size_t count) {
  std::mt19937_64 random(3);
  std::vector<int> times(weights.size(), 0);
  resample_systematically(
      weights.size(), [&](std::size_t i) { return weights[i]; }, total, count, random,
      [&](std::size_t i) { ++times[i]; });
  return times;
}

TEST(Resampling, DrawsEachAsOftenAsItsWeightSaysToOneMoreOrLess) {
  const std::vector<int> times = drawn({2, 0, 5, 1}, 8, 100);
  EXPECT_NEAR(times[0], 25, 1);
  EXPECT_EQ(times[1], 0);
  EXPECT_NEAR(times[2], 62.5, 1);
  EXPECT_NEAR(times[3], 12.5, 1);
  EXPECT_EQ(times[0] + times[2] + times[3], 100);
}

// The total passed may exceed the sum of the weights, by rounding or by far.
TEST(Resampling, WhatIsBeyondTheSumIsTheLast) {
  EXPECT_EQ(drawn({1, 1}, 4, 4), (std::vector<int>{1, 3}));
}

}  // namespace
}  // namespace milepost
