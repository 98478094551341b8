// What a vehicle's wheels say of its motion.
#pragma once

namespace milepost {

struct Odometry {
  double timestamp_s = 0;
  double speed_mps = 0;     // forwards
  double yaw_rate_dps = 0;  // degrees a second, clockwise
};

}  // namespace milepost
