// How a camera is mounted on its vehicle (FRAMES.md 8).
#pragma once

#include <Eigen/Geometry>

#include "schema/geo/camera_pose.h"
#include "schema/geo/geodesy.h"

namespace milepost {

// The pose of the camera relative to the vehicle's reference point, in the axes of the vehicle:
// forward, to the right, up.
struct Mounting {
  double forward_m = 0;
  double right_m = 0;
  double up_m = 0;
  double yaw_deg = 0;    // of the optical axis, clockwise from forward
  double pitch_deg = 0;  // upwards
  double roll_deg = 0;   // clockwise, as seen by the driver

  bool is_at_reference_point() const { return *this == Mounting(); }
  friend bool operator==(const Mounting&, const Mounting&) = default;
};

// The vehicle's frame has the axes of a camera that looks forward: x right, y down, z forward.
Eigen::Isometry3d vehicle_from_camera(const Mounting& mounting);
// The inverse. REQUIRES: the camera does not look straight up or down.
Mounting mounting_of(const Eigen::Isometry3d& vehicle_from_camera);

// A position with the attitude of a vehicle or a camera there.
struct GeoAttitude {
  GeoPoint position;
  double heading_deg = 0;  // clockwise from north, [0, 360)
  double pitch_deg = 0;    // upwards
  double roll_deg = 0;     // clockwise, as seen by the driver
};

// The camera of a vehicle, and the inverse.
GeoAttitude camera_of_vehicle(const GeoAttitude& vehicle, const Mounting& mounting);
GeoAttitude vehicle_of_camera(const GeoAttitude& camera, const Mounting& mounting);

}  // namespace milepost
