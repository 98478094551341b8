#include "client/evaluate/baselines/methods.h"

#include <gtest/gtest.h>

#include <cmath>

namespace milepost {
namespace {

TEST(CombineByMean, MeanAndSpreadByHand) {  // Eqs 4 and 5: of 1, 2, 6
  const auto measured = combine_by_mean({{1, 1}, {2, 9}, {6, 1}}, 0.01);
  ASSERT_TRUE(measured.has_value());
  EXPECT_DOUBLE_EQ(measured->along_m, 3);
  EXPECT_DOUBLE_EQ(measured->sigma_m, std::sqrt((4.0 + 1 + 9) / 3));
  EXPECT_EQ(measured->support, 3);
}

TEST(CombineByMean, OneEstimateIsNotCertain) {
  const auto measured = combine_by_mean({{5, 1}}, 0.25);
  ASSERT_TRUE(measured.has_value());
  EXPECT_DOUBLE_EQ(measured->sigma_m, 0.25);
  EXPECT_FALSE(combine_by_mean({}, 0.25).has_value());
}

}  // namespace
}  // namespace milepost
