#include "client/evaluate/drive_playback.h"

#include <algorithm>

namespace milepost {
namespace {

// Drives store GNSS times to the millisecond and frame times more precisely.
constexpr double kClockRoundingS = 0.001;

// Removes from the front of `left` the readings up to that time and returns them.
template <class Reading>
std::span<const Reading> taken_until(double timestamp_s, std::span<const Reading>& left) {
  const auto end = std::ranges::upper_bound(left, timestamp_s, {}, &Reading::timestamp_s);
  const auto count = static_cast<std::size_t>(end - left.begin());
  const std::span<const Reading> taken = left.first(count);
  left = left.subspan(count);
  return taken;
}

}  // namespace

std::span<const GpsFix> SensorLog::gps_until(double timestamp_s) {
  return taken_until(timestamp_s + kClockRoundingS, gps_);
}

std::span<const Odometry> SensorLog::odometry_until(double timestamp_s) {
  return taken_until(timestamp_s, odometry_);
}

void ignore_receiver_after(Drive& drive, double after_s) {
  const double last_s = drive.frames.front().timestamp_s + after_s + kClockRoundingS;
  std::erase_if(drive.gps, [&](const GpsFix& reading) { return reading.timestamp_s > last_s; });
}

Fix fix_without_map(double timestamp_s, bool had_fix) {
  Fix fix;
  fix.timestamp_s = timestamp_s;
  fix.status = had_fix ? FixStatus::lost : FixStatus::initializing;
  return fix;
}

}  // namespace milepost
