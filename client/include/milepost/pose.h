// A pose in six degrees of freedom with its covariance.
#pragma once

#include <array>

namespace milepost::vehicle {

// Of the vehicle's reference point.
struct Pose {
  double latitude_deg = 0;   // WGS84
  double longitude_deg = 0;  // WGS84
  double altitude_m = 0;     // above the WGS84 ellipsoid
  double heading_deg = 0;    // clockwise from north, [0, 360)
  double pitch_deg = 0;      // upwards
  double roll_deg = 0;       // clockwise as seen by the driver
  // Row-major covariance of east, north, up (metres), heading, pitch, roll (degrees).
  std::array<double, 36> covariance = {};
};

}  // namespace milepost::vehicle
