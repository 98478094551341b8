// Integrates odometry readings to increments between frames.
#pragma once

#include <optional>

#include "client/global/pose2.h"
#include "schema/geo/odometry.h"

namespace milepost {

// Each reading holds from its time to that of the next one.
class OdometryBuffer {
 public:
  // A reading that is not finite, or not later than the previous one, is ignored.
  void add(const Odometry& reading);

  // The motion from the last call up to `timestamp_s`; the first call starts at its own time.
  // REQUIRES: no reading later than `timestamp_s` was added.
  OdometryIncrement motion_until(double timestamp_s);

 private:
  void advance(double timestamp_s);

  std::optional<Odometry> latest_;
  std::optional<double> until_s_;  // time up to which `motion_` is integrated
  OdometryIncrement motion_;
};

}  // namespace milepost
