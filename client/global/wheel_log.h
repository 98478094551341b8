// The wheels' readings, and the motion that they tell of.
#pragma once

#include <optional>

#include "client/global/plan_pose.h"
#include "schema/geo/odometry.h"

namespace milepost {

// Adds up readings, each of which holds from its time to the next one's.
class WheelLog {
 public:
  // A reading that is not finite, or not later than the one before, is left out.
  void add(const Odometry& reading);

  // The motion since the last call, up to `timestamp_s`; the first call begins at its own time.
  // Readings later than `timestamp_s` must not have been added.
  WheelMotion motion_until(double timestamp_s);

 private:
  void advance(double timestamp_s);

  std::optional<Odometry> latest_;
  std::optional<double> until_s_;  // up to which `motion_` is added up
  WheelMotion motion_;
};

}  // namespace milepost
