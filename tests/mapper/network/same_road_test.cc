#include "mapper/network/same_road.h"

#include <gtest/gtest.h>

#include <initializer_list>
#include <utility>
#include <vector>

namespace milepost {
namespace {

struct Stretch {
  int length_m = 0;
  double apart_m = 0;
  double turn_deg = 0;
};

Alignment beside(std::initializer_list<Stretch> stretches) {
  Alignment alignment{0, 1, 100, {}};
  for (const Stretch& stretch : stretches) {
    for (int i = 0; i < stretch.length_m; ++i) {
      const auto along_b_m = static_cast<double>(alignment.matches.size());
      alignment.matches.push_back({along_b_m, stretch.apart_m, stretch.turn_deg, 0});
    }
  }
  return alignment;
}

// First and last metre of each stretch, counted from the begin of the alignment.
std::vector<std::pair<std::size_t, std::size_t>> stretches_of(const Alignment& alignment) {
  std::vector<std::pair<std::size_t, std::size_t>> found;
  for (const Alignment& part : same_road({alignment}, {})) {
    const std::size_t first = part.first - alignment.first;
    EXPECT_EQ(part.matches.front().along_b_m, static_cast<double>(first));
    found.emplace_back(first, first + part.matches.size() - 1);
  }
  return found;
}

TEST(SameRoad, HoldsOverAShortGap) {
  EXPECT_EQ(stretches_of(beside({{40, 2}, {12, 9}, {40, 2}})).size(), 1U);
  EXPECT_EQ(stretches_of(beside({{40, 2}, {25, 9}, {40, 2}})).size(), 2U);
}

TEST(SameRoad, HoldsWhileTheWaysMayBeTogether) {
  EXPECT_EQ(stretches_of(beside({{60, 4}, {50, 6.5}, {60, 4}})).size(), 1U);
  EXPECT_EQ(stretches_of(beside({{60, 4}, {50, 7.5}, {60, 4}})).size(), 2U);
}

TEST(SameRoad, EndsWhereTheWaysWereLastSurelyTogether) {
  const auto parting = stretches_of(beside({{60, 2}, {40, 6.5}, {40, 7.8}}));
  ASSERT_EQ(parting.size(), 1U);
  EXPECT_EQ(parting[0].first, 0U);
  EXPECT_NEAR(static_cast<double>(parting[0].second), 62, 3);
  const auto turning = stretches_of(beside({{60, 2, 1}, {10, 3, 30}, {10, 4, 60}}));
  ASSERT_EQ(turning.size(), 1U);
  EXPECT_NEAR(static_cast<double>(turning[0].second), 58, 4);
}

TEST(SameRoad, DoesNotEndWhereOneOfThemEnds) {
  const auto found = stretches_of(beside({{20, 6.5}, {60, 4}, {20, 6.5}}));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0], std::make_pair(std::size_t{0}, std::size_t{99}));
}

TEST(SameRoad, NeedsSomeLengthAndMostOfIt) {
  EXPECT_TRUE(stretches_of(beside({{50, 7.8}, {4, 2}, {50, 7.8}})).empty());
  EXPECT_TRUE(stretches_of(beside({{20, 4}, {80, 6.5}, {20, 4}})).empty());
  EXPECT_TRUE(stretches_of(beside({{100, 6.5}})).empty());
}

}  // namespace
}  // namespace milepost
