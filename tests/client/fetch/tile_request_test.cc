#include "client/fetch/tile_request.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace milepost::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::IsSupersetOf;

std::vector<TileEntry> index_of(const std::vector<AlongRange>& ranges) {
  std::vector<TileEntry> index;
  for (const AlongRange& range : ranges) {
    index.push_back({static_cast<std::uint32_t>(index.size()), range, 1, 100, "digest"});
  }
  return index;
}

std::vector<std::uint32_t> indices_of(const std::vector<TileEntry>& entries) {
  std::vector<std::uint32_t> indices;
  for (const TileEntry& entry : entries) indices.push_back(entry.index);
  return indices;
}

TEST(TileRequest, OneTileHasItsOwnUrl) {
  const auto request = request_for_first_run(index_of({{0, 12}, {10, 22}, {20, 32}}), {1});
  EXPECT_FALSE(request.range.has_value());
  EXPECT_THAT(indices_of(request.expected), ElementsAre(1));
}

TEST(TileRequest, ARunIsAskedForFromTheEndOfItsFirstToTheBeginningOfItsLast) {
  const auto index = index_of({{0, 12}, {10, 22}, {20, 32}, {30, 42}, {40, 52}});
  const auto request = request_for_first_run(index, {1, 2, 3});
  ASSERT_TRUE(request.range.has_value());
  EXPECT_EQ(request.range->from_m, 22);
  EXPECT_EQ(request.range->to_m, 30);
  EXPECT_THAT(indices_of(request.expected), ElementsAre(1, 2, 3));
}

TEST(TileRequest, OnlyTheFirstRunIsAskedFor) {
  const auto index = index_of({{0, 12}, {10, 22}, {20, 32}, {30, 42}, {40, 52}});
  EXPECT_THAT(indices_of(request_for_first_run(index, {0, 1, 3, 4}).expected), ElementsAre(0, 1));
}

TEST(TileRequest, TilesThatOverlapAreAskedForAtAPositionWithoutNeighbours) {
  // 1 and 2 share [20, 24]; tile 0 reaches to 21, tile 3 begins at 23.
  const auto index = index_of({{0, 21}, {10, 24}, {20, 33}, {23, 44}});
  const auto request = request_for_first_run(index, {1, 2});
  EXPECT_THAT(indices_of(request.expected), ElementsAre(1, 2));
  ASSERT_TRUE(request.range.has_value());
  EXPECT_EQ(request.range->from_m, 22);
  EXPECT_EQ(request.range->to_m, 22);
}

TEST(TileRequest, ATileFarLongerThanItsNeighboursComesAlong) {
  const auto index = index_of({{0, 100}, {10, 22}, {20, 32}, {30, 42}});
  EXPECT_THAT(indices_of(request_for_first_run(index, {2, 3}).expected), ElementsAre(0, 2, 3));
}

TEST(TileRequest, AlwaysBringsTheWholeRunInOrder) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> length_m(0, 60);
  std::bernoulli_distribution is_missing(0.5);
  for (int round = 0; round < 500; ++round) {
    std::vector<AlongRange> ranges;
    std::set<std::uint32_t> missing = {0};
    for (std::uint32_t k = 0; k < 12; ++k) {
      ranges.push_back({10.0 * k, 10.0 * k + length_m(random)});
      if (is_missing(random)) missing.insert(k);
    }
    const auto request = request_for_first_run(index_of(ranges), missing);
    std::vector<std::uint32_t> run;
    for (std::uint32_t k = 0; missing.contains(k); ++k) run.push_back(k);
    const auto expected = indices_of(request.expected);
    EXPECT_THAT(expected, IsSupersetOf(run));
    EXPECT_TRUE(std::ranges::is_sorted(expected));
  }
}

}  // namespace
}  // namespace milepost::testing
