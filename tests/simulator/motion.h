// A vehicle's motion along a route: speed with acceleration and braking, and position in its lane.
#pragma once

#include <cstdint>
#include <numbers>
#include <vector>

#include "tests/simulator/path.h"

namespace milepost::simulator {

// A smooth lateral displacement.
struct LaneChange {
  double from_m = 0;  // along the route
  double over_m = 40;
  double by_m = 0;  // positive to the right
};

struct MotionPlan {
  double from_m = 0;  // along the route
  double to_m = 100;
  double cruise_mps = 10;
  std::vector<double> slow_downs_m;  // arc lengths that are passed at walking speed
  double lateral_m = 0;              // from the lane's middle, positive to the right
  double wander_m = 0;               // amplitude of a slow sway about that
  std::vector<LaneChange> lane_changes;
  double start_s = 0;
  std::uint64_t seed = 1;
};

// A vehicle's motion over time. Immutable, so safe to share between threads.
class Motion {
 public:
  // `lane_m` is the lane's lateral offset, to the right of the path.
  // REQUIRES: to_m > from_m, cruise_mps > 0.
  Motion(Path path, double lane_m, const MotionPlan& plan);

  double start_s() const { return plan_.start_s; }
  double end_s() const { return plan_.start_s + times_s_.back(); }

  double time_s_at(double along_m) const;
  double along_m_at(double time_s) const;
  double speed_mps_at(double time_s) const;
  // East, north of the vehicle's middle, and its heading in radians, at an arc length.
  cv::Vec2d position_at(double along_m) const;
  double heading_rad_at(double along_m) const;
  // From the lane's middle, positive to the right.
  double offset_m_at(double along_m) const;

 private:
  std::vector<double> speeds() const;

  Path path_;
  double lane_m_;
  MotionPlan plan_;
  std::vector<double> times_s_;  // since the start, each kStepM
};

}  // namespace milepost::simulator
