// The camera model and how the camera is mounted on the vehicle.
#pragma once

#include <vector>

namespace milepost::vehicle {

enum class LensModel {
  pinhole,        // no distortion
  brown_conrady,  // radial and tangential: k1 k2 p1 p2 k3 k4 k5 k6, in OpenCV's order
  kannala_brandt  // fisheye: k1 k2 k3 k4, as OpenCV's
};

// Pose of the camera relative to the vehicle's reference point, in the axes of the vehicle: forward
// in the direction of travel, to the right, up.
struct Mounting {
  double forward_m = 0;
  double right_m = 0;
  double up_m = 0;
  double yaw_deg = 0;    // of the optical axis, clockwise from forward
  double pitch_deg = 0;  // upwards
  double roll_deg = 0;   // clockwise as seen by the driver
};

// Intrinsic parameters in pixels, with the origin at the centre of the top left pixel, x to the
// right and y down.
struct Camera {
  LensModel lens = LensModel::pinhole;
  int width_px = 0;       // of the images, above 0
  int height_px = 0;      // above 0
  double focal_x_px = 0;  // above 0
  double focal_y_px = 0;  // above 0
  double principal_x_px = 0;
  double principal_y_px = 0;
  std::vector<double> distortion = {};  // of the lens model; those left out are 0
  Mounting mounting = {};
};

}  // namespace milepost::vehicle
