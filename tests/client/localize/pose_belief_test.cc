#include "client/localize/pose_belief.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include <Eigen/Dense>

namespace milepost {
namespace {

PoseBelief driving_belief() {
  PoseBelief belief;
  belief.x << 30, -20, 2, 0.7, 0.02, -0.01, 0.03, 0.01, -0.02, 11, 0.15, 0.04, 0.02, -0.005;
  StateVector sigmas;
  sigmas << 0.1, 0.15, 0.2, 0.02, 0.01, 0.015, 0.01, 0.004, 0.004, 0.5, 0.1, 0.01, 0.02, 0.01;
  belief.P = sigmas.cwiseAbs2().asDiagonal();
  belief.P(kEast, kHeading) = belief.P(kHeading, kEast) = 0.5 * 0.1 * 0.02;
  belief.P(kSpeed, kNorth) = belief.P(kNorth, kSpeed) = -0.4 * 0.5 * 0.15;
  return belief;
}

// Simulates small time steps with white noise of acceleration, yaw acceleration, slip and mounting;
// the camera tilts once per frame.
class NoisyDrive {
 public:
  NoisyDrive(double slope, const PoseMotionSettings& settings)
      : slope_(slope), settings_(settings) {}

  StateVector after(StateVector state, double elapsed_s) {
    constexpr int kSteps = 20;
    const double dt = elapsed_s / kSteps;
    for (int step = 0; step < kSteps; ++step) {
      const double speed_gain = noise(settings_.acceleration_sigma, dt);
      const double yaw_rate_gain = noise(settings_.yaw_acceleration_sigma, dt);
      const double speed = state[kSpeed] + speed_gain / 2;
      const double yaw_rate = state[kYawRate] + yaw_rate_gain / 2;
      const double course_rad = state[kHeading] + yaw_rate * dt / 2 - state[kMounting];
      state[kEast] += speed * dt * std::sin(course_rad) + noise(settings_.slip_sigma, dt);
      state[kNorth] += speed * dt * std::cos(course_rad) + noise(settings_.slip_sigma, dt);
      state[kUp] += speed * dt * slope_ + noise(settings_.slip_sigma, dt);
      state[kHeading] += yaw_rate * dt;
      state[kSpeed] += speed_gain;
      state[kYawRate] += yaw_rate_gain;
      state[kMounting] += noise(settings_.mounting_sigma, dt);
    }
    state[kPitch] += noise(settings_.tilt_sigma_rad, 1);
    state[kRoll] += noise(settings_.tilt_sigma_rad, 1);
    return state;
  }

  StateVector drawn(const PoseBelief& belief) {
    StateVector unit;
    for (double& value : unit) value = normal_(random_);
    return belief.x + belief.P.llt().matrixL() * unit;
  }

 private:
  double noise(double sigma, double dt) { return sigma * std::sqrt(dt) * normal_(random_); }

  double slope_;
  PoseMotionSettings settings_;
  std::mt19937 random_{3};
  std::normal_distribution<double> normal_;
};

TEST(PoseBelief, PredictsWhatManyNoisyDrivesGive) {
  constexpr int kDrives = 20000;
  constexpr double kElapsedS = 0.1;
  constexpr double kSlope = 0.05;
  const PoseBelief before = driving_belief();
  const PoseMotionSettings settings;
  NoisyDrive drive(kSlope, settings);
  std::vector<StateVector> states;
  StateVector mean = StateVector::Zero();
  for (int i = 0; i < kDrives; ++i) {
    states.push_back(drive.after(drive.drawn(before), kElapsedS));
    mean += states.back() / kDrives;
  }
  StateMatrix covariance = StateMatrix::Zero();
  for (const StateVector& state : states) {
    covariance += (state - mean) * (state - mean).transpose() / kDrives;
  }
  const PoseBelief after = add_tilt_noise(predict(before, kElapsedS, kSlope, settings), settings);
  for (int i = 0; i < kStates; ++i) {
    const double variance_i = after.P(i, i);
    EXPECT_NEAR(mean[i], after.x[i], 5 * std::sqrt(variance_i / kDrives)) << i;
    for (int j = 0; j <= i; ++j) {
      const double expected = after.P(i, j);
      const double sampling_error =
          std::sqrt((variance_i * after.P(j, j) + expected * expected) / kDrives);
      EXPECT_NEAR(covariance(i, j), expected, 4 * sampling_error) << i << ", " << j;
    }
  }
}

TEST(PoseBelief, PassesEachUncertaintyOnAsTheMeanMoves) {  // derivatives against numerical ones
  constexpr double kElapsedS = 0.4;
  constexpr double kSlope = -0.03;
  const PoseMotionSettings settings;
  const LeverArm lever{1.2, 0.3};
  PoseBelief certain = driving_belief();
  certain.P.setZero();
  const StateMatrix noise = predict(certain, kElapsedS, kSlope, settings, lever).P;
  for (int j = 0; j < kStates; ++j) {
    constexpr double kDifference = 1e-4;
    PoseBelief less = certain;
    PoseBelief more = certain;
    less.x[j] -= kDifference;
    more.x[j] += kDifference;
    const StateVector by_j = (predict(more, kElapsedS, kSlope, settings, lever).x -
                              predict(less, kElapsedS, kSlope, settings, lever).x) /
                             (2 * kDifference);
    PoseBelief unsure = certain;
    unsure.P(j, j) = 1;
    const StateMatrix passed_on = predict(unsure, kElapsedS, kSlope, settings, lever).P - noise;
    EXPECT_LT((passed_on - by_j * by_j.transpose()).cwiseAbs().maxCoeff(), 1e-6) << j;
  }
}

TEST(PoseBelief, DrivesAnArc) {
  PoseBelief belief;
  belief.x[kHeading] = 0.3;
  belief.x[kMounting] = 0.3;  // so it drives to the north
  belief.x[kSpeed] = 10;
  belief.x[kYawRate] = 0.2;
  for (int i = 0; i < 100; ++i) belief = predict(belief, 0.05, 0, {});
  const double radius_m = 10 / 0.2;
  EXPECT_NEAR(belief.x[kEast], radius_m * (1 - std::cos(1.0)), 1e-3);
  EXPECT_NEAR(belief.x[kNorth], radius_m * std::sin(1.0), 1e-3);
  EXPECT_NEAR(belief.x[kHeading], 1.3, 1e-12);
}

// A camera ahead of the rear axle, and to the right of it, turns about it.
TEST(PoseBelief, ACameraOnAnArmSwingsOut) {
  PoseBelief belief;
  belief.x[kHeading] = 0.1;
  belief.x[kMounting] = 0.1;  // the vehicle heads north
  belief.x[kYawRate] = 0.5;
  const PoseBelief next = predict(belief, std::acos(-1.0), 0, {}, {2, 0.5});  // a quarter turn
  EXPECT_NEAR(next.x[kEast], 2 - 0.5, 1e-9);
  EXPECT_NEAR(next.x[kNorth], -2 - 0.5, 1e-9);
  EXPECT_NEAR(predict(belief, 1, 0, {}).x[kEast], 0, 1e-12);
}

TEST(PoseBelief, StandsStill) {
  PoseBelief before = driving_belief();
  before.x[kSpeed] = before.x[kYawRate] = 0;
  const PoseBelief after = predict(before, 2, 0.1, {});
  EXPECT_EQ(after.x, before.x);
  EXPECT_GT(after.P(kEast, kEast), before.P(kEast, kEast));
  // A camera at standstill gains no information about its mounting.
  EXPECT_EQ(after.P(kEast, kMounting), 0);
}

TEST(PoseBelief, OdometryIsWeightedByItsSigma) {
  PoseBelief before = driving_belief();  // 11 m/s, sigma 0.5
  before.x[kOdometryScale] = before.x[kYawRateBias] = 0;
  before.P(kOdometryScale, kOdometryScale) = before.P(kYawRateBias, kYawRateBias) = 0;
  OdometrySettings odometry;
  odometry.speed_sigma_mps = 0.5;
  odometry.yaw_rate_sigma = 0.1;  // as the belief's
  const PoseBelief after = odometry_update(before, 10, 0.25, odometry);
  EXPECT_NEAR(after.x[kSpeed], 10.5, 1e-12);
  EXPECT_NEAR(after.x[kYawRate], 0.2, 1e-12);
  EXPECT_NEAR(after.P(kSpeed, kSpeed), 0.5 * 0.5 / 2, 1e-12);
  EXPECT_NEAR(after.P(kYawRate, kYawRate), 0.1 * 0.1 / 2, 1e-12);
  // North goes with speed by -0.4 of the sigmas, so it is corrected with it; heading is not.
  EXPECT_NEAR(after.x[kNorth], before.x[kNorth] + 0.4 * 0.15 / 0.5 * 0.5, 1e-12);
  EXPECT_LT(after.P(kNorth, kNorth), before.P(kNorth, kNorth));
  EXPECT_EQ(after.x[kHeading], before.x[kHeading]);
  EXPECT_LT((after.P - after.P.transpose()).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(PoseBelief, EstimatesOdometryScaleAndBias) {
  PoseBelief belief = driving_belief();
  belief.x[kOdometryScale] = belief.x[kYawRateBias] = 0;
  const auto know = [&](PoseState state, double value, double sigma) {
    belief.x[state] = value;
    belief.P.row(state).setZero();
    belief.P.col(state).setZero();
    belief.P(state, state) = sigma * sigma;
  };
  for (int i = 0; i < 200; ++i) {
    know(kSpeed, 10, 0.01);  // as if by many landmarks
    know(kYawRate, 0.1, 0.001);
    belief = odometry_update(belief, 10.2, 0.092, {});
  }
  EXPECT_NEAR(belief.x[kOdometryScale], 0.02, 0.001);
  EXPECT_NEAR(belief.x[kYawRateBias], -0.008, 0.001);
  EXPECT_LT(std::sqrt(belief.P(kOdometryScale, kOdometryScale)), 0.002);
  know(kSpeed, 10, 5);  // and then only odometry is left
  EXPECT_NEAR(odometry_update(belief, 5.1, 0.1, {}).x[kSpeed], 5, 0.02);
}

TEST(PoseBelief, ClimbsWithTheRoad) {
  PoseBelief before = driving_belief();
  const PoseBelief after = predict(before, 0.5, 0.08, {});
  EXPECT_DOUBLE_EQ(after.x[kUp], before.x[kUp] + 11 * 0.5 * 0.08);
}

}  // namespace
}  // namespace milepost
