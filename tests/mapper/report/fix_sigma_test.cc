#include "mapper/report/fix_sigma.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include <Eigen/Dense>

#include "schema/geo/camera_pose.h"

namespace milepost {
namespace {

SightedLandmark landmark(double ahead_m, double right_m, double up_m) {
  SightedLandmark made;
  made.at_m = {ahead_m, right_m, up_m};
  made.mapping_ray = made.at_m.normalized();
  made.depth_sigma_m = 0.1;
  made.size_m = 0.2;
  made.size_sigma = 0.1;
  return made;
}

std::vector<SightedLandmark> some_landmarks() {
  return {landmark(8, 4, 1),    landmark(12, -5, 3), landmark(20, 6, -1), landmark(30, -8, 4),
          landmark(15, 3, 0.5), landmark(40, 10, 6), landmark(25, -2, 2)};
}

// Of bearings alone, as they are before the client adds what it does not model.
FixSettings bearings_alone() {
  FixSettings settings;
  settings.scale_sigma = 1e6;
  settings.min_sigma_m = 0;
  settings.missed_variance = 0;
  return settings;
}

using Pose6 = Eigen::Matrix<double, 6, 1>;  // east, north, up, heading, pitch, roll

// Where a camera sees a landmark, in focal lengths, by the camera model of schema/geo.
Eigen::Vector2d image_of(const Eigen::Vector3d& landmark_enu_m, const Pose6& pose) {
  const Eigen::Vector3d seen =
      camera_from_enu(CameraPose{pose.head<3>(), pose[3], pose[4], pose[5]}) *
      (landmark_enu_m - pose.head<3>());
  return {seen.x() / seen.z(), seen.y() / seen.z()};
}

template <int kSize>
Eigen::Matrix<double, 2, kSize> derivative(
    const std::function<Eigen::Vector2d(const Eigen::Matrix<double, kSize, 1>&)>& function,
    const Eigen::Matrix<double, kSize, 1>& at) {
  constexpr double kStep = 1e-6;
  Eigen::Matrix<double, 2, kSize> by;
  for (int k = 0; k < kSize; ++k) {
    Eigen::Matrix<double, kSize, 1> step = Eigen::Matrix<double, kSize, 1>::Zero();
    step[k] = kStep;
    by.col(k) = (function(at + step) - function(at - step)) / (2 * kStep);
  }
  return by;
}

// The sigmas along and across of a camera that looks north, by numerical derivatives.
FixSigma numerically(const std::vector<SightedLandmark>& landmarks, double focal_px,
                     const FixSettings& settings) {
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
  Pose6 before;
  before << settings.lateral_sigma_m, settings.along_sigma_m, settings.up_sigma_m,
      settings.heading_sigma_rad, settings.tilt_sigma_rad, settings.tilt_sigma_rad;
  information.diagonal() = before.cwiseAbs2().cwiseInverse();
  for (const SightedLandmark& each : landmarks) {
    const Eigen::Vector3d enu_m(each.at_m.y(), each.at_m.x(), each.at_m.z());
    const Eigen::Vector3d ray(each.mapping_ray.y(), each.mapping_ray.x(), each.mapping_ray.z());
    const auto by_pose =
        derivative<6>([&](const Pose6& pose) { return image_of(enu_m, pose); }, Pose6::Zero());
    const auto by_landmark = derivative<3>(
        [&](const Eigen::Vector3d& at) { return image_of(at, Pose6::Zero()); }, enu_m);
    const double scale_px = each.size_m * focal_px / each.at_m.x();
    const double sigma =
        std::hypot(settings.pixel_sigma_px, settings.pixel_per_scale * scale_px) / focal_px;
    const Eigen::Matrix3d of_landmark =
        ray * ray.transpose() * std::pow(each.depth_sigma_m, 2) +
        Eigen::Matrix3d::Identity() * std::pow(settings.landmark_sigma_m, 2);
    const Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity() * sigma * sigma +
                                       by_landmark * of_landmark * by_landmark.transpose();
    information += by_pose.transpose() * covariance.inverse() * by_pose;
  }
  const Eigen::Matrix<double, 6, 6> covariance = information.inverse();
  return {std::sqrt(covariance(1, 1)), std::sqrt(covariance(0, 0))};
}

TEST(FixSigma, IsThatOfNumericalDerivatives) {
  const FixSettings settings = bearings_alone();
  const FixSigma expected = numerically(some_landmarks(), 500, settings);
  const FixSigma found = fix_sigma(some_landmarks(), 500, settings);
  EXPECT_NEAR(found.along_m, expected.along_m, 1e-6);
  EXPECT_NEAR(found.lateral_m, expected.lateral_m, 1e-6);
  EXPECT_LT(found.along_m, 0.2);
}

TEST(FixSigma, WithoutLandmarksIsThatBeforeTheImage) {
  const FixSettings settings;
  const double factor = std::sqrt(1 + settings.missed_variance);  // nothing is found
  EXPECT_NEAR(fix_sigma({}, 500).along_m, factor * std::hypot(2, 0.02), 1e-9);
  const std::vector<SightedLandmark> behind = {landmark(-5, 2, 1)};
  EXPECT_NEAR(fix_sigma(behind, 500).worse_m(), factor * std::hypot(2.5, 0.02), 1e-9);
}

TEST(FixSigma, GrowsWithWhatIsMissing) {
  std::vector<SightedLandmark> few = some_landmarks();
  const double all_m = fix_sigma(few, 500).worse_m();
  few.resize(3);
  EXPECT_GT(fix_sigma(few, 500).worse_m(), all_m);
  std::vector<SightedLandmark> rarely_found = some_landmarks();
  for (SightedLandmark& each : rarely_found) each.found = 0.3;
  EXPECT_GT(fix_sigma(rarely_found, 500).worse_m(), 1.5 * all_m);
  std::vector<SightedLandmark> blurred = some_landmarks();
  for (SightedLandmark& each : blurred) each.mapping_ray = {0, 1, 0};  // seen from aside
  EXPECT_GT(fix_sigma(blurred, 500).worse_m(), all_m);
}

TEST(FixSigma, ScalesTellTheDepth) {
  FixSettings settings = bearings_alone();
  const std::vector<SightedLandmark> ahead = {landmark(20, 0, 0)};  // its bearing tells no depth
  const double by_bearing_m = fix_sigma(ahead, 500, settings).along_m;
  settings.scale_sigma = 0.02;
  settings.shared_scale_sigma = 0.001;
  EXPECT_NEAR(by_bearing_m, settings.along_sigma_m, 0.01);
  EXPECT_LT(fix_sigma(ahead, 500, settings).along_m, 0.9 * by_bearing_m + 0.2);
}

TEST(FixSigma, IsNeverLessThanTheClients) {
  std::vector<SightedLandmark> many;
  for (int i = 0; i < 2000; ++i) many.push_back(landmark(5 + i % 30, i % 11 - 5, i % 4));
  EXPECT_NEAR(fix_sigma(many, 500).worse_m(), 0.02, 0.003);
}

TEST(ProbabilityOfSight, IsByObservationsAndDrives) {
  EXPECT_DOUBLE_EQ(probability_of_sight(4, 1, 1, 4), 0.5);
  EXPECT_DOUBLE_EQ(probability_of_sight(4, 1, 4, 4), 0.5 * 1.5 / 4.5);
  EXPECT_DOUBLE_EQ(probability_of_sight(12, 3, 1, 4), 0.75);  // a drive that passed twice
}

}  // namespace
}  // namespace milepost
