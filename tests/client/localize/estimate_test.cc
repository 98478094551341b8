#include "client/localize/estimate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace milepost {
namespace {

std::vector<PositionEstimate> noisy_estimates(double along_m, int good, int wrong) {
  std::mt19937 random(11);
  std::normal_distribution<double> noise(0, 1);
  std::uniform_real_distribution<double> anywhere(-20, 20);
  std::uniform_real_distribution<double> sigma(0.1, 1.0);
  std::vector<PositionEstimate> estimates;
  for (int i = 0; i < good; ++i) {
    const double sigma_m = sigma(random);
    estimates.push_back({along_m + sigma_m * noise(random), sigma_m});
  }
  for (int i = 0; i < wrong; ++i) {
    estimates.push_back({along_m + 8 + anywhere(random), sigma(random)});
  }
  return estimates;
}

TEST(CombineRobustly, IsNotMovedByWrongMatches) {
  const auto estimates = noisy_estimates(200, 60, 40);
  const auto robust = combine_robustly(estimates, {});
  ASSERT_TRUE(robust.has_value());
  EXPECT_NEAR(robust->along_m, 200, 0.15);
  double mean_m = 0;
  for (const PositionEstimate& estimate : estimates) mean_m += estimate.along_m / 100;
  EXPECT_GT(std::abs(mean_m - 200), 1.5);
}

TEST(CombineRobustly, SigmaTellsHowFarItIsOff) {
  const auto robust = combine_robustly(noisy_estimates(200, 400, 0), {});
  ASSERT_TRUE(robust.has_value());
  EXPECT_LT(std::abs(robust->along_m - 200), 4 * robust->sigma_m);
  EXPECT_LT(robust->sigma_m, 0.3);
}

TEST(CombineRobustly, IsTheWeightedMeanWhereAllAgree) {
  RobustSettings settings;
  settings.cutoff = 1e6;  // trusts all
  settings.shared_part = 0;
  const auto robust = combine_robustly({{10, 1}, {10.4, 1}, {11, 0.5}}, settings);
  ASSERT_TRUE(robust.has_value());
  EXPECT_NEAR(robust->along_m, (10 + 10.4 + 4 * 11) / 6, 1e-9);
  EXPECT_NEAR(robust->sigma_m, std::sqrt(1 / 6.0), 1e-6);
}

// Spread by hand: weights 1, 1, 4 about 10.733: (0.538 + 0.111 + 4 * 0.071) / 6 = 0.1556.
TEST(CombineRobustly, APartOfTheSpreadIsShared) {
  RobustSettings settings;
  settings.cutoff = 1e6;
  settings.shared_part = 0.5;
  const auto robust = combine_robustly({{10, 1}, {10.4, 1}, {11, 0.5}}, settings);
  ASSERT_TRUE(robust.has_value());
  EXPECT_NEAR(robust->shared_sigma_m, 0.5 * std::sqrt(0.155556), 1e-6);
  EXPECT_NEAR(robust->sigma_m, std::hypot(std::sqrt(1 / 6.0), robust->shared_sigma_m), 1e-6);
}

TEST(CombineRobustly, NeedsSupport) {
  EXPECT_FALSE(combine_robustly({}, {}).has_value());
  EXPECT_FALSE(combine_robustly({{1, 0.1}, {1, 0.1}}, {}).has_value());
  EXPECT_FALSE(combine_robustly({{1, 0.1}, {50, 0.1}, {100, 0.1}}, {}).has_value());
}

}  // namespace
}  // namespace milepost
