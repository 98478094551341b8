#include "client/global/odometry_buffer.h"

#include <cmath>
#include <utility>

#include "schema/geo/geodesy.h"

namespace milepost {

void OdometryBuffer::add(const Odometry& reading) {
  if (!std::isfinite(reading.timestamp_s) || !std::isfinite(reading.speed_mps) ||
      !std::isfinite(reading.yaw_rate_dps)) {
    return;
  }
  if (latest_ && reading.timestamp_s <= latest_->timestamp_s) return;
  if (until_s_) advance(reading.timestamp_s);
  latest_ = reading;
}

OdometryIncrement OdometryBuffer::motion_until(double timestamp_s) {
  if (until_s_) advance(timestamp_s);
  until_s_ = timestamp_s;
  return std::exchange(motion_, {});
}

void OdometryBuffer::advance(double timestamp_s) {
  const double duration_s = timestamp_s - *until_s_;
  if (duration_s <= 0) return;
  motion_.duration_s += duration_s;
  until_s_ = timestamp_s;
  if (!latest_) return;
  motion_.distance_m += latest_->speed_mps * duration_s;
  motion_.turn_rad += latest_->yaw_rate_dps * kRadPerDeg * duration_s;
}

}  // namespace milepost
