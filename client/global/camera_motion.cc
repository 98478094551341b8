#include "client/global/camera_motion.h"

#include <cmath>

#include "schema/geo/geodesy.h"

namespace milepost {
namespace {

// Turns about x, y, z, and of the way about x and y, all in radians.
using Correction = Eigen::Matrix<double, 5, 1>;

// How far the camera may be from what the wheels tell: bumps, a mounting that is not quite level.
const Correction kPriorSigmas = Correction(1.0, 0.7, 0.7, 3.0, 2.0) * kRadPerDeg;

constexpr int kIterations = 6;
constexpr double kStep = 1e-5;

Eigen::Matrix3d rotation(const Eigen::Vector3d& turn_rad) {
  const double angle = turn_rad.norm();
  if (angle == 0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, turn_rad / angle).toRotationMatrix();
}

CameraMotion corrected(const CameraMotion& motion, const Correction& by) {
  return {rotation(by.head<3>()) * motion.now_from_before,
          rotation({by[3], by[4], 0}) * motion.way_m};
}

}  // namespace

CameraMotion camera_motion(const WheelMotion& wheels) {
  CameraMotion motion;
  motion.now_from_before =
      Eigen::AngleAxisd(-wheels.turn_rad, Eigen::Vector3d::UnitY()).toRotationMatrix();
  motion.way_m = wheels.distance_m *
                 Eigen::Vector3d(std::sin(wheels.turn_rad / 2), 0, std::cos(wheels.turn_rad / 2));
  return motion;
}

double epipolar_distance(const RayPair& pair, const CameraMotion& motion) {
  // now . (R (way x before)) = 0 for a point that stands still.
  const Eigen::Matrix3d& r = motion.now_from_before;
  const Eigen::Vector3d line_now = r * motion.way_m.cross(pair.before);
  const Eigen::Vector3d line_before = (r.transpose() * pair.now).cross(motion.way_m);
  const double scale =
      std::sqrt(line_now.head<2>().squaredNorm() + line_before.head<2>().squaredNorm());
  return scale > 0 ? pair.now.dot(line_now) / scale : 0;
}

CameraMotion refined_motion(std::span<const RayPair> pairs, const CameraMotion& start,
                            double ray_sigma) {
  Correction by = Correction::Zero();
  for (int i = 0; i < kIterations; ++i) {
    Eigen::Matrix<double, 5, 5> information =
        kPriorSigmas.array().square().inverse().matrix().asDiagonal();
    Correction gradient = -information * by;
    const CameraMotion motion = corrected(start, by);
    std::array<CameraMotion, 5> beside;
    for (int k = 0; k < 5; ++k) beside[k] = corrected(start, by + kStep * Correction::Unit(k));
    for (const RayPair& pair : pairs) {
      const double error = epipolar_distance(pair, motion) / ray_sigma;
      Correction slope;
      for (int k = 0; k < 5; ++k) {
        slope[k] = (epipolar_distance(pair, beside[k]) / ray_sigma - error) / kStep;
      }
      // Geman and McClure's weight.
      const double weight = 1 / std::pow(1 + error * error / 9, 2);
      information += weight * slope * slope.transpose();
      gradient -= weight * error * slope;
    }
    by += information.ldlt().solve(gradient);
  }
  return corrected(start, by);
}

}  // namespace milepost
