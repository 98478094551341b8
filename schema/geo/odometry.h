// A reading of a vehicle's wheel odometry.
#pragma once

namespace milepost {

struct Odometry {
  double timestamp_s = 0;
  double speed_mps = 0;     // forwards
  double yaw_rate_dps = 0;  // degrees per second, clockwise
};

}  // namespace milepost
