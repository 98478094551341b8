#include "client/global/camera_motion.h"

#include <array>
#include <cmath>

#include "client/estimation/robust_weights.h"
#include "schema/geo/geodesy.h"

namespace milepost {
namespace {

// Rotations about x, y, z, and of the translation about x and y, all in radians.
using Correction = Eigen::Matrix<double, 5, 1>;

// Standard deviations of the camera's motion relative to odometry: bumps, a mounting that is not
// level.
const Correction kPriorSigmas = Correction(1.0, 0.7, 0.7, 3.0, 2.0) * kRadPerDeg;

constexpr int kIterations = 6;
constexpr double kStep = 1e-5;

Eigen::Matrix3d rotation(const Eigen::Vector3d& turn_rad) {
  const double angle = turn_rad.norm();
  if (angle == 0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, turn_rad / angle).toRotationMatrix();
}

Eigen::Isometry3d corrected(const Eigen::Isometry3d& before_from_now, const Correction& by) {
  Eigen::Isometry3d corrected = Eigen::Isometry3d::Identity();
  corrected.linear() = before_from_now.linear() * rotation(by.head<3>()).transpose();
  corrected.translation() = rotation({by[3], by[4], 0}) * before_from_now.translation();
  return corrected;
}

}  // namespace

Eigen::Isometry3d camera_motion(const OdometryIncrement& odometry) {
  const double turn_rad = odometry.turn_rad;
  Eigen::Isometry3d before_from_now = Eigen::Isometry3d::Identity();
  before_from_now.linear() =
      Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::UnitY()).toRotationMatrix();
  before_from_now.translation() =
      odometry.distance_m * Eigen::Vector3d(std::sin(turn_rad / 2), 0, std::cos(turn_rad / 2));
  return before_from_now;
}

double epipolar_distance(const RayPair& pair, const Eigen::Isometry3d& before_from_now) {
  // now . (R (t x before)) = 0 for a static point.
  const Eigen::Matrix3d now_from_before = before_from_now.linear().transpose();
  const Eigen::Vector3d distance_m = before_from_now.translation();
  const Eigen::Vector3d line_now = now_from_before * distance_m.cross(pair.before);
  const Eigen::Vector3d line_before = (before_from_now.linear() * pair.now).cross(distance_m);
  const double scale =
      std::sqrt(line_now.head<2>().squaredNorm() + line_before.head<2>().squaredNorm());
  return scale > 0 ? pair.now.dot(line_now) / scale : 0;
}

Eigen::Isometry3d refined_motion(std::span<const RayPair> pairs, const Eigen::Isometry3d& start,
                                 double ray_sigma) {
  Correction by = Correction::Zero();
  for (int i = 0; i < kIterations; ++i) {
    Eigen::Matrix<double, 5, 5> information =
        kPriorSigmas.array().square().inverse().matrix().asDiagonal();
    Correction gradient = -information * by;
    const Eigen::Isometry3d motion = corrected(start, by);
    std::array<Eigen::Isometry3d, 5> beside;
    for (int k = 0; k < 5; ++k) beside[k] = corrected(start, by + kStep * Correction::Unit(k));
    for (const RayPair& pair : pairs) {
      const double error = epipolar_distance(pair, motion) / ray_sigma;
      Correction slope;
      for (int k = 0; k < 5; ++k) {
        slope[k] = (epipolar_distance(pair, beside[k]) / ray_sigma - error) / kStep;
      }
      const double weight = geman_mcclure_weight(error, 3);
      information += weight * slope * slope.transpose();
      gradient -= weight * error * slope;
    }
    by += information.ldlt().solve(gradient);
  }
  return corrected(start, by);
}

}  // namespace milepost
