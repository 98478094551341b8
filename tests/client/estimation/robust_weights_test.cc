#include "client/estimation/robust_weights.h"

#include <gtest/gtest.h>

namespace milepost {
namespace {

TEST(RobustWeights, AreOneAtZeroAndEven) {
  for (const auto weight : {cauchy_weight, geman_mcclure_weight, biweight}) {
    EXPECT_EQ(weight(0, 3), 1);
    EXPECT_EQ(weight(-1.5, 3), weight(1.5, 3));
  }
}

TEST(RobustWeights, FallAsTheirNamesSay) {
  EXPECT_DOUBLE_EQ(cauchy_weight(3, 3), 0.5);
  EXPECT_DOUBLE_EQ(geman_mcclure_weight(3, 3), 0.25);
  EXPECT_DOUBLE_EQ(biweight(1, 2), 0.5625);
  EXPECT_EQ(biweight(2, 2), 0);
  EXPECT_EQ(biweight(5, 2), 0);
}

}  // namespace
}  // namespace milepost
