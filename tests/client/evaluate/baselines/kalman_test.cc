#include "client/evaluate/baselines/kalman.h"

#include <gtest/gtest.h>

#include <cmath>

namespace milepost {
namespace {

TEST(ConstantVelocity, StepsByTheLastSpeedOverTheNextInterval) {  // Eq. 16
  EXPECT_DOUBLE_EQ(constant_velocity_step_m(10, 1.0, 12, 1.2, 1.5), 2.0 / 0.2 * 0.3);
  EXPECT_DOUBLE_EQ(constant_velocity_step_m(10, 1.0, 10, 1.2, 1.5), 0);
}

// By hand: sigma^2 = 0.25, sigma_w = 0.5 -> predicted variance 0.5; measurement sigma 1 -> K = 1/3.
TEST(PaperKalman, PredictAndUpdateByHand) {
  const AlongBelief predicted = predict(AlongBelief{100, 0.25}, 2, 0.5);  // Eq. 9
  EXPECT_DOUBLE_EQ(predicted.along_m, 102);
  EXPECT_DOUBLE_EQ(predicted.variance_m2, 0.5);
  const AlongBelief updated = update(predicted, {103.5, 1, 10}, 1);  // Eqs 10, 11
  EXPECT_DOUBLE_EQ(updated.along_m, 102 + 1.5 / 3);
  EXPECT_DOUBLE_EQ(updated.variance_m2, 0.5 * 2 / 3);
}

TEST(PaperKalman, TheWeightMultipliesTheMeasurementsVariance) {  // section 4.2.3
  const AlongBelief predicted{102, 0.5};
  EXPECT_DOUBLE_EQ(update(predicted, {103.5, 1, 10}, 2.5).along_m, 102 + 1.5 * 0.5 / 3);
  EXPECT_NEAR(update(predicted, {103.5, 1, 10}, 0).along_m, 103.5, 1e-12);
}

// By hand: speed 10 +- 2, arc length 50 +- 1, 0.5 s -> arc length 55, variance 1 + 0.25 * 4 + q /
// 24.
TEST(MotionKalman, PredictByHand) {
  MotionBelief belief;
  belief.x = {50, 10};
  belief.P << 1, 0, 0, 4;
  const MotionBelief predicted = predict(belief, 0.5, 2);
  EXPECT_DOUBLE_EQ(predicted.x[0], 55);
  EXPECT_DOUBLE_EQ(predicted.x[1], 10);
  EXPECT_NEAR(predicted.P(0, 0), 1 + 0.25 * 4 + 4 * 0.125 / 3, 1e-12);
  EXPECT_NEAR(predicted.P(0, 1), 0.5 * 4 + 4 * 0.25 / 2, 1e-12);
  EXPECT_NEAR(predicted.P(1, 1), 4 + 4 * 0.5, 1e-12);
}

// By hand: variances 2 and 2 -> gain 1/2 on arc length, covariance(0,1) / 4 = 1/4 on speed.
TEST(MotionKalman, UpdateByHand) {
  MotionBelief predicted;
  predicted.x = {55, 10};
  predicted.P << 2, 1, 1, 4;
  const MotionBelief updated = update(predicted, {57, std::sqrt(2.0), 9});
  EXPECT_NEAR(updated.x[0], 56, 1e-12);
  EXPECT_NEAR(updated.x[1], 10.5, 1e-12);
  EXPECT_NEAR(updated.P(0, 0), 1, 1e-12);
  EXPECT_NEAR(updated.P(0, 1), 0.5, 1e-12);
  EXPECT_NEAR(updated.P(1, 0), 0.5, 1e-12);
  EXPECT_NEAR(updated.P(1, 1), 4 - 0.25, 1e-12);
}

}  // namespace
}  // namespace milepost
