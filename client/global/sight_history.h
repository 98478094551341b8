// What was seen over the last stretch of way, so that a place can be asked how well it explains all
// of it.
#pragma once

#include <cstddef>
#include <deque>

#include "client/global/plan_pose.h"
#include "client/global/wall_observer.h"

namespace milepost {

struct HistorySettings {
  double step_m = 5;          // at least so far apart are the sights that are kept
  double way_m = 100;         // older ones are forgotten
  std::size_t each_beam = 3;  // one of so many is kept, and stands for them
};

struct PastSight {
  WallObservation observation;
  double way_m = 0;     // that it stands for: since the sight before
  double driven_m = 0;  // at that time, since the start of the drive
  PlanPose driven;      // where it was, as the wheels went from the start of the drive
};

// Not safe to use from several threads at once.
class SightHistory {
 public:
  explicit SightHistory(const HistorySettings& settings) : settings_(settings) {}

  // Whether the observation was kept: it has beams, and is far enough from the last one.
  // `motion` is that since the last call.
  bool add(const WallObservation& observation, const WheelMotion& motion);

  const std::deque<PastSight>& sights() const { return sights_; }
  std::size_t each_beam() const { return settings_.each_beam; }
  // Where a vehicle that is at `now` had the sight, as the wheels went: their metres are multiplied
  // by their scale.
  PlanPose pose_then(const PlanPose& now, double wheel_scale, const PastSight& sight) const;

 private:
  HistorySettings settings_;
  PlanPose driven_;
  double driven_m_ = 0;
  double since_last_m_ = 0;
  std::deque<PastSight> sights_;  // the oldest first
};

}  // namespace milepost
