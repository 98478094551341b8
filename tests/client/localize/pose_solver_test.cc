#include "client/localize/pose_solver.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include <Eigen/Dense>

#include "tests/client/localize/landmark_scene.h"

namespace milepost {
namespace {

using testing::angle_error_deg;
using testing::kSceneCamera;
using testing::LandmarkScene;
using testing::position_error_m;

constexpr double kNothing = 1e4;  // an uninformative sigma

PoseSolver solver_of(const LandmarkScene& scene, const PoseSolverSettings& settings = {}) {
  return {kSceneCamera, scene.features, scene.landmarks, settings};
}

// The true state, moved by `metres` per axis and rotated by `degrees` about each axis.
StateVector beside(const LandmarkScene& scene, double metres, double degrees) {
  StateVector state = scene.state();
  state.head<3>() += Eigen::Vector3d(metres, -metres, metres / 2);
  const double angle_rad = degrees * kRadPerDeg;
  state.segment<3>(kHeading) += Eigen::Vector3d(angle_rad, -angle_rad, angle_rad);
  return state;
}

TEST(PoseSolver, FindsTheExactPoseFromExactFeatures) {
  const LandmarkScene scene(60);
  const StateVector start = beside(scene, 0.5, 2);
  const PoseBelief unknown = LandmarkScene::belief(start, kNothing, kNothing);
  const PoseEstimate estimate = solver_of(scene).estimate(unknown, start, scene.matches);
  EXPECT_LT(position_error_m(estimate.belief, scene.pose), 1e-4);  // features are floats
  EXPECT_LT(angle_error_deg(estimate.belief, scene.pose), 1e-4);
  EXPECT_EQ(estimate.agreeing.size(), scene.matches.size());
  EXPECT_NEAR(estimate.belief.x[kSpeed], start[kSpeed], 1e-6);
}

// Newton steps double the number of digits only if the derivatives are right.
TEST(PoseSolver, ConvergesWithinFewSteps) {
  const LandmarkScene scene(60);
  const StateVector start = beside(scene, 0.02, 0.05);
  const PoseBelief unknown = LandmarkScene::belief(start, kNothing, kNothing);
  PoseSolverSettings settings;
  settings.iterations = 1;
  const PoseEstimate estimate = solver_of(scene, settings).estimate(unknown, start, scene.matches);
  EXPECT_LT(position_error_m(estimate.belief, scene.pose), 1e-4);
  EXPECT_LT(angle_error_deg(estimate.belief, scene.pose), 1e-4);
}

TEST(PoseSolver, DerivativesAreThoseOfTheSquaredPixelErrors) {
  const LandmarkScene scene(30);
  PoseSolverSettings settings;
  settings.scale_sigma = kNothing;
  const PoseSolver solver = solver_of(scene, settings);
  const PoseBelief before = LandmarkScene::belief(scene.state(), 1, 1);
  const PoseEstimate estimate = solver.estimate(before, before.x, scene.matches);
  const StateMatrix information = estimate.belief.P.inverse() - before.P.inverse();

  const auto half_squares = [&](const StateVector& state) {
    double sum = 0;
    for (const LandmarkMatch& match : scene.matches) {
      sum += std::pow(solver.pixel_sigmas(state, {match}).front(), 2) / 2;
    }
    return sum;
  };
  Eigen::Matrix<double, kSpeed, kSpeed> numerical;  // second differences about the minimum
  for (int i = 0; i < kSpeed; ++i) {
    for (int j = 0; j < kSpeed; ++j) {
      const auto at = [&](double of_i, double of_j) {
        StateVector state = scene.state();
        state[i] += of_i * (i < 3 ? 1e-3 : 1e-4);
        state[j] += of_j * (j < 3 ? 1e-3 : 1e-4);
        return half_squares(state);
      };
      const double area = (i < 3 ? 1e-3 : 1e-4) * (j < 3 ? 1e-3 : 1e-4);
      numerical(i, j) = (at(1, 1) - at(1, -1) - at(-1, 1) + at(-1, -1)) / (4 * area);
    }
  }
  for (int i = 0; i < kSpeed; ++i) {
    for (int j = 0; j < kSpeed; ++j) {
      const double size = std::sqrt(numerical(i, i) * numerical(j, j));
      EXPECT_NEAR(information(i, j) / size, numerical(i, j) / size, 2e-3) << i << ", " << j;
    }
  }
}

TEST(PoseSolver, FindsHowFarTheCalibrationIsOff) {
  const LandmarkScene scene(60);
  Pinhole wrong = kSceneCamera;
  wrong.focal_x_px *= 1.05;
  wrong.focal_y_px *= 1.05;
  wrong.principal_x_px += 0.01 * wrong.focal_x_px;
  PoseBelief before = LandmarkScene::belief(scene.state(), 1, 3);
  before.x[kEast] += 0.3;
  for (const int i : {kLogFocal, kPrincipalX, kPrincipalY}) before.P(i, i) = 0.01;
  const PoseSolver solver(wrong, scene.features, scene.landmarks, {});
  const PoseEstimate estimate = solver.estimate(before, before.x, scene.matches);
  EXPECT_EQ(estimate.agreeing.size(), scene.matches.size());
  EXPECT_LT(position_error_m(estimate.belief, scene.pose), 0.02);
  EXPECT_NEAR(estimate.belief.x[kLogFocal], -std::log(1.05), 1e-3);
  EXPECT_NEAR(estimate.belief.x[kPrincipalX], -0.01, 1e-3);
  EXPECT_NEAR(estimate.belief.x[kPrincipalY], 0, 1e-3);
}

// In other light many matches are wrong by no more than the search gate, and the others exact.
TEST(PoseSolver, WrongMatchesWithinTheSigmasHardlyPull) {
  LandmarkScene scene(100);
  for (std::size_t i = 0; i < 35; ++i) scene.features[i].x_px += 2.5F;
  const PoseBelief before = LandmarkScene::belief(beside(scene, 0.1, 0.3), 0.2, 0.5);
  const PoseEstimate estimate = solver_of(scene).estimate(before, before.x, scene.matches);
  EXPECT_LT(position_error_m(estimate.belief, scene.pose), 0.005);
  PoseSolverSettings wide;
  wide.biweight_deviations = 100;
  const PoseEstimate pulled = solver_of(scene, wide).estimate(before, before.x, scene.matches);
  EXPECT_GT(position_error_m(pulled.belief, scene.pose),
            3 * position_error_m(estimate.belief, scene.pose));
}

TEST(PoseSolver, ItsCovarianceIsConsistent) {
  constexpr int kTrials = 300;
  PoseSolverSettings settings;
  // Gaussian noise: nothing is cut off.
  settings.cauchy = settings.cutoff = settings.biweight_deviations = 100;
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  double sum = 0;
  int within = 0;
  for (unsigned trial = 0; trial < kTrials; ++trial) {
    LandmarkScene scene(40, trial);
    const PoseBelief spread = LandmarkScene::belief(scene.state(), 0.3, 0.5);
    PoseBelief before = spread;
    for (int i = 0; i < kStates; ++i) {
      before.x[i] += std::sqrt(spread.P(i, i)) * normal(random);
    }
    for (std::size_t i = 0; i < scene.landmarks.size(); ++i) {
      LocalLandmark& landmark = scene.landmarks[i];
      Feature& feature = scene.features[i];
      const double pixel_sigma_px =
          std::hypot(settings.pixel_sigma_px, settings.pixel_per_scale * feature.scale_px);
      feature.x_px += static_cast<float>(pixel_sigma_px * normal(random));
      feature.y_px += static_cast<float>(pixel_sigma_px * normal(random));
      feature.scale_px *= static_cast<float>(std::exp(settings.scale_sigma * normal(random)));
      landmark.depth_sigma_m = 0.2;
      landmark.size_sigma = 0.1;
      landmark.size_m *= std::exp(landmark.size_sigma * normal(random));
      const Eigen::Vector3d off(normal(random), normal(random), normal(random));
      landmark.enu_m += settings.landmark_sigma_m * off;
      landmark.enu_m += landmark.depth_sigma_m * normal(random) * landmark.mapping_ray;
    }
    const PoseEstimate estimate =
        solver_of(scene, settings).estimate(before, before.x, scene.matches);
    const Eigen::Matrix<double, 6, 1> error = (estimate.belief.x - scene.state()).head<6>();
    const Eigen::Matrix<double, 6, 6> covariance = estimate.belief.P.topLeftCorner<6, 6>();
    const double normalized = error.dot(covariance.inverse() * error);
    sum += normalized;
    if (normalized < 12.59) ++within;  // 95 % of chi squared of six degrees of freedom
  }
  EXPECT_NEAR(sum / kTrials, 6, 0.8);  // 4 standard errors, sqrt(12 / 300)
  EXPECT_NEAR(within, 0.95 * kTrials, 15);
}

TEST(PoseSolver, WrongMatchesDoNotMoveIt) {
  LandmarkScene scene(60);
  const PoseBelief before = LandmarkScene::belief(beside(scene, 0.2, 0.5), 0.5, 1);
  for (std::size_t i = 0; i < 24; ++i) scene.matches[i].landmark = 59 - i;  // 40 %
  const PoseEstimate estimate = solver_of(scene).estimate(before, before.x, scene.matches);
  EXPECT_LT(position_error_m(estimate.belief, scene.pose), 0.01);
  EXPECT_LT(angle_error_deg(estimate.belief, scene.pose), 0.05);
  EXPECT_GE(estimate.agreeing.size(), 36U);
  EXPECT_LE(estimate.agreeing.size(), 38U);
  for (const LandmarkMatch& match : estimate.agreeing) {
    EXPECT_LT(solver_of(scene).pixel_sigmas(estimate.belief.x, {match}).front(),
              PoseSolverSettings().cutoff);
  }
}

// Two landmarks far ahead: along the road their bearings hardly change, their scales do.
TEST(PoseSolver, WithFewLandmarksScaleDeterminesArcLength) {
  LandmarkScene scene(0);
  const Eigen::Matrix3d enu_from_camera = camera_from_enu(scene.pose).transpose();
  for (const double x_m : {-0.5, 0.5}) {
    const Eigen::Vector3d seen(x_m, 0.1, 25);
    scene.landmarks.push_back(testing::landmark_at(scene.pose.enu_m + enu_from_camera * seen, 0.4));
    scene.landmarks.back().size_sigma = 0.015;
    scene.features.push_back(testing::seen_feature(scene.landmarks.back(), scene.pose));
    scene.matches.push_back({scene.matches.size(), scene.matches.size()});
  }
  const Eigen::Vector3d ahead = enu_from_camera.col(2);
  PoseBelief before = LandmarkScene::belief(scene.state(), 0.1, 1);
  before.x.head<3>() -= 2 * ahead;
  before.P.topLeftCorner<3, 3>() += 9 * ahead * ahead.transpose();
  const auto along = [&](double scale_sigma) {
    PoseSolverSettings settings;
    settings.scale_sigma = scale_sigma;
    settings.shared_scale_sigma = 1e-4;
    const PoseBelief after =
        solver_of(scene, settings).estimate(before, before.x, scene.matches).belief;
    const Eigen::Matrix3d covariance = after.P.topLeftCorner<3, 3>();
    return std::pair(ahead.dot(after.x.head<3>() - scene.pose.enu_m),
                     std::sqrt(ahead.dot(covariance * ahead)));
  };
  const auto [error_m, sigma_m] = along(0.02);
  EXPECT_NEAR(error_m, 0, 0.1);
  EXPECT_NEAR(sigma_m, 25 * std::hypot(0.02, 0.015) / std::sqrt(2), 0.02);
  const auto [blind_error_m, blind_sigma_m] = along(kNothing);
  EXPECT_LT(blind_error_m, -0.5);
  EXPECT_GT(blind_sigma_m, 1.5);
}

// In a frame out of focus all features are larger by the same factor, which no number of them
// averages out.
TEST(PoseSolver, WhatAllScalesShareIsNotAveragedOut) {
  LandmarkScene scene(0);
  const Eigen::Matrix3d enu_from_camera = camera_from_enu(scene.pose).transpose();
  constexpr double kDepthM = 40;
  constexpr double kLarger = 1.05;
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d seen(0.1 * (i % 10) - 0.45, 0.1 * (i / 10) - 0.45, kDepthM);
    scene.landmarks.push_back(testing::landmark_at(scene.pose.enu_m + enu_from_camera * seen, 0.4));
    scene.features.push_back(testing::seen_feature(scene.landmarks.back(), scene.pose));
    scene.features.back().scale_px *= static_cast<float>(kLarger);
    scene.matches.push_back({scene.matches.size(), scene.matches.size()});
  }
  const Eigen::Vector3d ahead = enu_from_camera.col(2);
  PoseBelief before = LandmarkScene::belief(scene.state(), 0.1, 1);
  before.P.topLeftCorner<3, 3>() += 9 * ahead * ahead.transpose();
  const PoseBelief after = solver_of(scene).estimate(before, before.x, scene.matches).belief;
  const Eigen::Matrix3d covariance = after.P.topLeftCorner<3, 3>();
  const double sigma_m = std::sqrt(ahead.dot(covariance * ahead));
  EXPECT_LT(std::abs(ahead.dot(after.x.head<3>() - scene.pose.enu_m)), 2.5 * sigma_m);
  EXPECT_GT(sigma_m, 0.5);  // 0.12 of 40 m by a hundred would be 0.48
  EXPECT_LT(sigma_m, kDepthM * 0.06);
}

TEST(PoseSolver, WithoutMatchesItGivesTheBeliefBack) {
  const LandmarkScene scene(5);
  const PoseBelief before = LandmarkScene::belief(beside(scene, 0.5, 2), 0.5, 1);
  const PoseEstimate estimate = solver_of(scene).estimate(before, scene.state(), {});
  EXPECT_LT((estimate.belief.x - before.x).norm(), 1e-9);
  EXPECT_LT((estimate.belief.P - before.P).norm(), 1e-9);
  EXPECT_TRUE(estimate.agreeing.empty());
}

TEST(PoseSolver, TwoMatchesCompleteTheBeliefToAPose) {
  LandmarkScene scene(2);
  PoseBelief before = LandmarkScene::belief(scene.state(), 2, 0.1);
  before.P(kHeading, kHeading) = std::pow(6 * kRadPerDeg, 2);
  before.x[kEast] += 1.5;
  before.x[kNorth] -= 1;
  before.x[kHeading] += 5 * kRadPerDeg;
  const StateVector proposed =
      solver_of(scene).hypothesis(before, before.P.inverse(), scene.matches);
  EXPECT_NEAR(proposed[kEast], scene.pose.enu_m.x(), 0.1);
  EXPECT_NEAR(proposed[kNorth], scene.pose.enu_m.y(), 0.1);
  EXPECT_NEAR(proposed[kHeading], scene.pose.heading_rad, 0.3 * kRadPerDeg);
}

TEST(PoseSolver, ALandmarkBehindTheCameraAgreesWithNothing) {
  LandmarkScene scene(20);
  scene.landmarks[0].enu_m = 2 * scene.pose.enu_m - scene.landmarks[0].enu_m;
  const PoseBelief before = LandmarkScene::belief(beside(scene, 0.1, 0.1), 0.5, 1);
  EXPECT_EQ(solver_of(scene).pixel_sigmas(scene.state(), {{0, 0}}).front(),
            std::numeric_limits<double>::infinity());
  const PoseEstimate estimate = solver_of(scene).estimate(before, before.x, scene.matches);
  EXPECT_LT(position_error_m(estimate.belief, scene.pose), 0.01);
  EXPECT_EQ(estimate.agreeing.size(), 19U);
}

TEST(PoseSolver, AFeatureIsAsUncertainAsItIsLarge) {
  LandmarkScene scene(1);
  PoseSolverSettings settings;
  settings.landmark_sigma_m = 0;
  scene.features[0].x_px += 10;
  for (const double scale_px : {1.0, 50.0}) {
    scene.features[0].scale_px = static_cast<float>(scale_px);
    const double sigma_px =
        std::hypot(settings.pixel_sigma_px, settings.pixel_per_scale * scale_px);
    EXPECT_NEAR(solver_of(scene, settings).pixel_sigmas(scene.state(), {{0, 0}}).front(),
                10 / sigma_px, 1e-3);
  }
}

// A landmark is uncertain along its mapping ray: from the side this is a pixel error, along the ray
// it is none.
TEST(PoseSolver, DepthIsUncertainAlongTheMappingRay) {
  LandmarkScene scene(1);
  scene.features[0].x_px += 20;
  scene.landmarks[0].depth_sigma_m = 2;
  const Eigen::Matrix3d enu_from_camera = camera_from_enu(scene.pose).transpose();
  scene.landmarks[0].mapping_ray = (scene.landmarks[0].enu_m - scene.pose.enu_m).normalized();
  const double as_mapped = solver_of(scene).pixel_sigmas(scene.state(), {{0, 0}}).front();
  scene.landmarks[0].mapping_ray = enu_from_camera.col(0);  // mapped from the side
  const double from_aside = solver_of(scene).pixel_sigmas(scene.state(), {{0, 0}}).front();
  EXPECT_GT(as_mapped, 10);
  EXPECT_LT(from_aside, 2);
}

}  // namespace
}  // namespace milepost
