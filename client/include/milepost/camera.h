// The vehicle's camera: how it sees, and how it is mounted.
#pragma once

#include <vector>

namespace milepost::vehicle {

enum class LensModel {
  pinhole,        // no distortion
  brown_conrady,  // radial and tangential: k1 k2 p1 p2 k3 ..., as OpenCV orders them
  kannala_brandt  // fisheye: k1 k2 k3 k4
};

// From the vehicle's reference point to the camera. The vehicle's axes: forward along its
// direction of travel, to the right, up.
struct Mounting {
  double forward_m = 0;
  double right_m = 0;
  double up_m = 0;
  double yaw_deg = 0;    // where it looks, clockwise from forward
  double pitch_deg = 0;  // upwards
  double roll_deg = 0;   // clockwise, as the driver sees it
};

// In pixels from the centre of the top left pixel, x to the right, y down.
struct Camera {
  LensModel lens = LensModel::pinhole;
  int width_px = 0;       // of its images, above 0
  int height_px = 0;      // above 0
  double focal_x_px = 0;  // above 0
  double focal_y_px = 0;  // above 0
  double principal_x_px = 0;
  double principal_y_px = 0;
  std::vector<double> distortion = {};  // of the lens model; empty or zeros: none
  Mounting mounting = {};
};

}  // namespace milepost::vehicle
