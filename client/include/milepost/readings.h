// What the vehicle's other sensors say.
#pragma once

#include <optional>

namespace milepost::vehicle {

// All timestamps of a vehicle are seconds of one clock, whichever it is.

// Of a receiver of satellite signals. Finite; within the ranges.
struct ReceiverReading {
  double timestamp_s = 0;
  double latitude_deg = 0;   // [-90, 90], WGS84
  double longitude_deg = 0;  // [-180, 180], WGS84
  double altitude_m = 0;     // above the ellipsoid; plays no part where it is not known
  double sigma_m = 0;        // one standard deviation, in each direction, above 0
  // Where it is known which way the vehicle looks, clockwise from north, within 30 degrees or so:
  // road that leads elsewhere is no place to start.
  std::optional<double> heading_deg = {};
};

// Of the wheels.
struct OdometryReading {
  double timestamp_s = 0;
  double speed_mps = 0;
  double yaw_rate_dps = 0;  // clockwise
};

}  // namespace milepost::vehicle
