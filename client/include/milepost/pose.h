// Six degrees of freedom, and how sure they are.
#pragma once

#include <array>

namespace milepost::vehicle {

// Of the vehicle's reference point in the world.
struct Pose {
  double latitude_deg = 0;   // WGS84
  double longitude_deg = 0;  // WGS84
  double altitude_m = 0;     // above the ellipsoid
  double heading_deg = 0;    // clockwise from north, [0, 360)
  double pitch_deg = 0;      // upwards
  double roll_deg = 0;       // clockwise, as the driver sees it
  // Row by row, of: east, north, up (metres), heading, pitch, roll (degrees).
  std::array<double, 36> covariance = {};
};

}  // namespace milepost::vehicle
