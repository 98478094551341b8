// The pinhole camera model (FRAMES.md 7).
#pragma once

#include <cmath>

#include <Eigen/Core>

namespace milepost {

inline constexpr double kNearestSeenM = 0.5;  // depth below which a point is not visible

// In pixels from the centre of the top left pixel.
struct Pinhole {
  double focal_x_px = 0;
  double focal_y_px = 0;
  double principal_x_px = 0;
  double principal_y_px = 0;

  // The focal length that relates scale and depth.
  double focal_px() const { return std::sqrt(focal_x_px * focal_y_px); }

  // The image of a point in the camera frame. REQUIRES: it lies in front of the camera.
  template <class Scalar>
  Eigen::Matrix<Scalar, 2, 1> project(const Eigen::Matrix<Scalar, 3, 1>& camera_m) const {
    return {Scalar(principal_x_px) + Scalar(focal_x_px) * camera_m.x() / camera_m.z(),
            Scalar(principal_y_px) + Scalar(focal_y_px) * camera_m.y() / camera_m.z()};
  }

  // The Jacobian of project with respect to the point.
  Eigen::Matrix<double, 2, 3> projection_jacobian(const Eigen::Vector3d& camera_m) const {
    const double z = camera_m.z();
    Eigen::Matrix<double, 2, 3> derivative;
    derivative << focal_x_px / z, 0, -focal_x_px * camera_m.x() / (z * z), 0, focal_y_px / z,
        -focal_y_px * camera_m.y() / (z * z);
    return derivative;
  }

  // The ray through a pixel in the camera frame, with z = 1.
  Eigen::Vector3d unproject(double x_px, double y_px) const {
    return {(x_px - principal_x_px) / focal_x_px, (y_px - principal_y_px) / focal_y_px, 1};
  }

  friend bool operator==(const Pinhole&, const Pinhole&) = default;
};

}  // namespace milepost
