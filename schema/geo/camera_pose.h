// Camera poses (FRAMES.md 4 and 7).
#pragma once

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace milepost {

// The pose of a vehicle's camera in a tangent frame, with six degrees of freedom. `Scalar` is
// double, or the type of an automatic differentiation.
template <class Scalar>
struct CameraPoseOf {
  using Vector3 = Eigen::Matrix<Scalar, 3, 1>;
  using Matrix3 = Eigen::Matrix<Scalar, 3, 3>;

  Vector3 enu_m = Vector3::Zero();
  Scalar heading_rad{0};  // clockwise from north
  Scalar pitch_rad{0};    // upwards
  Scalar roll_rad{0};     // clockwise, as seen by the driver
};
using CameraPose = CameraPoseOf<double>;

// Factors of camera_from_enu = roll * pitch * level.
template <class Scalar>
typename CameraPoseOf<Scalar>::Matrix3 level_camera_from_enu(const Scalar& heading_rad) {
  using std::cos;
  using std::sin;
  const Scalar c = cos(heading_rad);
  const Scalar s = sin(heading_rad);
  const Scalar o(0);
  typename CameraPoseOf<Scalar>::Matrix3 m;
  m << c, -s, o, o, o, Scalar(-1), s, c, o;
  return m;
}

template <class Scalar>
typename CameraPoseOf<Scalar>::Matrix3 pitched_from_level(const Scalar& pitch_rad) {
  using std::cos;
  using std::sin;
  const Scalar c = cos(pitch_rad);
  const Scalar s = sin(pitch_rad);
  const Scalar o(0);
  typename CameraPoseOf<Scalar>::Matrix3 m;
  m << Scalar(1), o, o, o, c, s, o, -s, c;
  return m;
}

template <class Scalar>
typename CameraPoseOf<Scalar>::Matrix3 rolled_from_pitched(const Scalar& roll_rad) {
  using std::cos;
  using std::sin;
  const Scalar c = cos(roll_rad);
  const Scalar s = sin(roll_rad);
  const Scalar o(0);
  typename CameraPoseOf<Scalar>::Matrix3 m;
  m << c, s, o, -s, c, o, o, o, Scalar(1);
  return m;
}

template <class Scalar>
typename CameraPoseOf<Scalar>::Matrix3 camera_from_enu(const CameraPoseOf<Scalar>& pose) {
  return rolled_from_pitched(pose.roll_rad) * pitched_from_level(pose.pitch_rad) *
         level_camera_from_enu(pose.heading_rad);
}

// Transforms a point from the tangent frame to the camera frame (x right, y down, z forward).
template <class Scalar>
typename CameraPoseOf<Scalar>::Vector3 point_in_camera(
    const CameraPoseOf<Scalar>& pose, const typename CameraPoseOf<Scalar>::Vector3& point_enu_m) {
  return camera_from_enu(pose) * (point_enu_m - pose.enu_m);
}

// The transform from the camera frame (x right, y down, z forward) to the tangent frame.
inline Eigen::Isometry3d enu_from_camera(const CameraPose& pose) {
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  transform.linear() = camera_from_enu(pose).transpose();
  transform.translation() = pose.enu_m;
  return transform;
}

// The inverse of the above. REQUIRES: the camera does not look straight up or down.
inline CameraPose pose_of(const Eigen::Isometry3d& enu_from_camera) {
  const Eigen::Vector3d right = enu_from_camera.linear().col(0);
  const Eigen::Vector3d forward = enu_from_camera.linear().col(2);
  CameraPose pose;
  pose.enu_m = enu_from_camera.translation();
  pose.heading_rad = std::atan2(forward.x(), forward.y());
  pose.pitch_rad = std::asin(std::clamp(forward.z(), -1.0, 1.0));
  const Eigen::Matrix3d unrolled = camera_from_enu(pose);
  pose.roll_rad = std::atan2(unrolled.row(1).dot(right), unrolled.row(0).dot(right));
  return pose;
}

}  // namespace milepost
