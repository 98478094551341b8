#include "schema/feature/descriptor_index.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace milepost {
namespace {

std::vector<Descriptor> random_descriptors(unsigned seed, std::size_t count) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> byte(0, 160);
  std::vector<Descriptor> descriptors(count);
  for (Descriptor& descriptor : descriptors) {
    for (auto& value : descriptor) value = static_cast<std::uint8_t>(byte(random));
  }
  return descriptors;
}

std::vector<Descriptor> disturbed(const std::vector<Descriptor>& descriptors) {
  std::mt19937 random(5);
  std::uniform_int_distribution<int> noise(-12, 12);
  std::vector<Descriptor> queries = descriptors;
  for (Descriptor& query : queries) {
    for (auto& value : query)
      value = static_cast<std::uint8_t>(std::clamp(value + noise(random), 0, 255));
  }
  return queries;
}

TEST(DescriptorIndex, FindsTheNearest) {
  const auto descriptors = random_descriptors(1, 800);
  const auto queries = disturbed(descriptors);
  const DescriptorIndex index(descriptors, {});
  const auto found = index.nearest(queries, 2);
  int right = 0;
  for (std::size_t i = 0; i < queries.size(); ++i) {
    ASSERT_EQ(found[i].size(), 2U);
    EXPECT_LE(found[i][0].distance_squared, found[i][1].distance_squared);
    EXPECT_FLOAT_EQ(found[i][0].distance_squared,
                    distance_squared(queries[i], descriptors[found[i][0].index]));
    right += found[i][0].index == i ? 1 : 0;
  }
  EXPECT_GE(right, 720);  // the search is approximate
}

TEST(DescriptorIndex, GivesTheSameNeighboursEachTime) {
  const auto descriptors = random_descriptors(2, 500);
  const auto queries = disturbed(descriptors);
  const auto first = DescriptorIndex(descriptors, {}).nearest(queries, 3);
  const auto again = DescriptorIndex(descriptors, {}).nearest(queries, 3);
  for (std::size_t i = 0; i < queries.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(first[i][k].index, again[i][k].index);
  }
}

TEST(DescriptorIndex, HoldsFewerThanAskedFor) {
  const auto descriptors = random_descriptors(3, 2);
  const auto found = DescriptorIndex(descriptors, {}).nearest(descriptors, 5);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].size(), 2U);
  EXPECT_TRUE(DescriptorIndex({}, {}).nearest(descriptors, 5)[0].empty());
}

}  // namespace
}  // namespace milepost
