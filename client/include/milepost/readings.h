// Readings of the vehicle's other sensors.
#pragma once

#include <optional>

namespace milepost::vehicle {

// All timestamps of a vehicle are in seconds of the same clock; its epoch is arbitrary.

// A GNSS position. All values are finite and within their ranges.
struct ReceiverReading {
  double timestamp_s = 0;
  double latitude_deg = 0;   // [-90, 90], WGS84
  double longitude_deg = 0;  // [-180, 180], WGS84
  double altitude_m = 0;     // above the WGS84 ellipsoid; leave it at 0 where unknown
  double sigma_m = 0;        // one standard deviation per axis, above 0
  // Heading of the vehicle, clockwise from north, if known to about 30 degrees: roads that lead
  // elsewhere are not considered when localization starts.
  std::optional<double> heading_deg = {};
};

// A wheel odometry reading.
struct OdometryReading {
  double timestamp_s = 0;
  double speed_mps = 0;
  double yaw_rate_dps = 0;  // positive clockwise
};

}  // namespace milepost::vehicle
