// Where a camera is and how it looks, and the image of a point (FRAMES.md 4 and 7).
#pragma once

#include <cmath>

#include <Eigen/Core>

namespace milepost {

// Six degrees of freedom of a vehicle's camera in a tangent frame. `Scalar` is double, or what a
// solver differentiates with.
template <class Scalar>
struct CameraPoseOf {
  using Vector3 = Eigen::Matrix<Scalar, 3, 1>;
  using Matrix3 = Eigen::Matrix<Scalar, 3, 3>;

  Vector3 enu_m = Vector3::Zero();
  Scalar heading_rad{0};  // clockwise from north
  Scalar pitch_rad{0};    // upwards
  Scalar roll_rad{0};     // clockwise, as the driver sees it
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

// A point of the tangent frame in the camera's: x right, y down, z forward.
template <class Scalar>
typename CameraPoseOf<Scalar>::Vector3 seen_from(
    const CameraPoseOf<Scalar>& pose, const typename CameraPoseOf<Scalar>::Vector3& point_enu_m) {
  return camera_from_enu(pose) * (point_enu_m - pose.enu_m);
}

inline constexpr double kNearestSeenM = 0.5;  // what is nearer to the camera's plane is not seen

// A camera without distortion.
struct Pinhole {
  double focal_x_px = 0;
  double focal_y_px = 0;
  double principal_x_px = 0;
  double principal_y_px = 0;

  // By which scale and depth are related.
  double focal_px() const { return std::sqrt(focal_x_px * focal_y_px); }

  // REQUIRES: the point lies before the camera.
  template <class Scalar>
  Eigen::Matrix<Scalar, 2, 1> pixel_of(const Eigen::Matrix<Scalar, 3, 1>& camera_m) const {
    return {Scalar(principal_x_px) + Scalar(focal_x_px) * camera_m.x() / camera_m.z(),
            Scalar(principal_y_px) + Scalar(focal_y_px) * camera_m.y() / camera_m.z()};
  }

  // The direction that a pixel looks in, with z = 1.
  Eigen::Vector3d ray_of(double x_px, double y_px) const {
    return {(x_px - principal_x_px) / focal_x_px, (y_px - principal_y_px) / focal_y_px, 1};
  }
};

}  // namespace milepost
