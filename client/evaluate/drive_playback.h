// What it takes to play a recorded drive to a localizer or a finder.
#pragma once

#include <chrono>
#include <span>

#include "client/localize/localizer.h"
#include "schema/drive/drive.h"

namespace milepost {

// The receiver's and the wheels' readings of a drive, each told once its time has come. The drive
// must outlive it.
class SensorLog {
 public:
  explicit SensorLog(const Drive& drive) : gps_(drive.gps), odometry_(drive.odometry) {}

  // Those up to that time that were not told yet.
  std::span<const GpsFix> gps_until(double timestamp_s);
  std::span<const Odometry> odometry_until(double timestamp_s);

 private:
  // What is left to tell.
  std::span<const GpsFix> gps_;
  std::span<const Odometry> odometry_;
};

// Of a frame whose map did not come.
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
