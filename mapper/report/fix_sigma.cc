#include "mapper/report/fix_sigma.h"

#include <cmath>

#include <Eigen/Dense>

#include "schema/geo/pinhole.h"

namespace milepost {
namespace {

// The pose: ahead, right, up; heading, clockwise; pitch, upwards; roll.
constexpr int kStates = 6;
using PoseMatrix = Eigen::Matrix<double, kStates, kStates>;
using PoseVector = Eigen::Matrix<double, kStates, 1>;

PoseMatrix information_before(const FixSettings& settings) {
  PoseVector sigmas;
  sigmas << settings.along_sigma_m, settings.lateral_sigma_m, settings.up_sigma_m,
      settings.heading_sigma_rad, settings.tilt_sigma_rad, settings.tilt_sigma_rad;
  return sigmas.cwiseAbs2().cwiseInverse().asDiagonal();
}

// The derivatives of the image of a landmark at (ahead, right, up), in focal lengths right and
// down: by the pose, and by the landmark's own position.
Eigen::Matrix<double, 2, 3> image_by_landmark(const Eigen::Vector3d& at_m) {
  const double ahead = at_m.x();
  const double squared = ahead * ahead;
  Eigen::Matrix<double, 2, 3> by;
  by << -at_m.y() / squared, 1 / ahead, 0, at_m.z() / squared, 0, -1 / ahead;
  return by;
}

Eigen::Matrix<double, 2, kStates> image_by_pose(const Eigen::Vector3d& at_m) {
  const double x = at_m.y() / at_m.x();
  const double y = -at_m.z() / at_m.x();
  Eigen::Matrix<double, 2, kStates> by;
  by.leftCols<3>() = -image_by_landmark(at_m);
  by.rightCols<3>() << -1 - x * x, x * y, y, -x * y, 1 + y * y, -x;
  return by;
}

// Of the logarithm of a feature's scale, which falls with the distance ahead.
PoseVector log_scale_by_pose(const Eigen::Vector3d& at_m) {
  PoseVector by = PoseVector::Zero();
  by[0] = 1 / at_m.x();
  by[3] = -at_m.y() / at_m.x();
  by[4] = -at_m.z() / at_m.x();
  return by;
}

}  // namespace

double probability_of_sight(double observations, double passes, double passes_there,
                            double half_repeated_at) {
  constexpr double kPriorSeen = 0.5;
  constexpr double kPriorPasses = 0.5;
  const double by_drives = std::min(1.0, (passes + kPriorSeen) / (passes_there + kPriorPasses));
  return by_drives * observations / (observations + half_repeated_at);
}

FixSigma fix_sigma(const std::vector<SightedLandmark>& landmarks, double focal_px,
                   const FixSettings& settings) {
  PoseMatrix information = information_before(settings);
  // The scale error that all features share is a state that is marginalized.
  double shared_information = 1 / (settings.shared_scale_sigma * settings.shared_scale_sigma);
  PoseVector shared_by_pose = PoseVector::Zero();
  double expected = 0;
  double found = 0;
  for (const SightedLandmark& landmark : landmarks) {
    const double ahead_m = landmark.at_m.x();
    if (!(ahead_m > kNearestSeenM)) continue;
    ++expected;
    found += landmark.found;
    const double scale_px = landmark.size_m * focal_px / ahead_m;
    const double pixel_sigma =
        std::hypot(settings.pixel_sigma_px, settings.pixel_per_scale * scale_px) / focal_px;
    const Eigen::Matrix<double, 2, 3> by_landmark = image_by_landmark(landmark.at_m);
    const Eigen::Vector2d along_ray = by_landmark * landmark.mapping_ray * landmark.depth_sigma_m;
    const Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity() * pixel_sigma * pixel_sigma +
                                       along_ray * along_ray.transpose() +
                                       by_landmark * by_landmark.transpose() *
                                           settings.landmark_sigma_m * settings.landmark_sigma_m;
    const Eigen::Matrix<double, 2, kStates> by_pose = image_by_pose(landmark.at_m);
    information += landmark.found * by_pose.transpose() * covariance.inverse() * by_pose;

    const double depth = landmark.depth_sigma_m / ahead_m;
    const double of_scale =
        landmark.found / (settings.scale_sigma * settings.scale_sigma +
                          landmark.size_sigma * landmark.size_sigma + depth * depth);
    const PoseVector scale_by_pose = log_scale_by_pose(landmark.at_m);
    information += of_scale * scale_by_pose * scale_by_pose.transpose();
    shared_information += of_scale;
    shared_by_pose += of_scale * scale_by_pose;
  }
  information -= shared_by_pose * shared_by_pose.transpose() / shared_information;
  const PoseMatrix covariance = information.inverse();
  const double missed = expected > 0 ? 1 - found / expected : 1;
  const double factor = std::sqrt(1 + settings.missed_variance * missed * missed);
  const auto reported = [&](double variance) {
    return factor * std::hypot(std::sqrt(variance), settings.min_sigma_m);
  };
  return {reported(covariance(0, 0)), reported(covariance(1, 1))};
}

}  // namespace milepost
