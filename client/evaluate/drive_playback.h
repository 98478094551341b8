// Helpers to replay a recorded drive to a localizer.
#pragma once

#include <chrono>
#include <span>

#include "client/localize/localizer.h"
#include "schema/drive/drive.h"

namespace milepost {

// The GNSS and odometry readings of a drive, each returned once its time has come. REQUIRES: the
// drive outlives this object.
class SensorLog {
 public:
  explicit SensorLog(const Drive& drive) : gps_(drive.gps), odometry_(drive.odometry) {}

  // The readings up to that time that were not returned before.
  std::span<const GpsFix> gps_until(double timestamp_s);
  std::span<const Odometry> odometry_until(double timestamp_s);

 private:
  std::span<const GpsFix> gps_;
  std::span<const Odometry> odometry_;
};

// Removes the GNSS readings later than `after_s` seconds after the first frame, as in a tunnel.
void ignore_receiver_after(Drive& drive, double after_s);

// The fix of a frame whose map data did not arrive.
Fix fix_without_map(double timestamp_s, bool had_fix);

class Stopwatch {
 public:
  double ms() const {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_)
        .count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace milepost
