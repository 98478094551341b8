// The observations over the last distance travelled, to evaluate how well a pose explains all of
// them.
#pragma once

#include <cstddef>
#include <deque>

#include "client/global/pose2.h"
#include "client/global/wall_observer.h"

namespace milepost {

struct MeasurementWindowSettings {
  double step_m = 5;            // minimum distance between the observations kept
  double distance_m = 100;      // length of the window
  std::size_t beam_stride = 3;  // one of this many beams is kept and represents them
};

struct PastMeasurement {
  WallObservation observation;
  double distance_m = 0;  // that it represents: since the previous observation
  double driven_m = 0;    // distance at that time, since the start of the drive
  Pose2 driven;           // pose at that time by odometry from the start of the drive
};

// Not safe to use from several threads at once.
class MeasurementWindow {
 public:
  explicit MeasurementWindow(const MeasurementWindowSettings& settings) : settings_(settings) {}

  // Returns whether the observation was kept: it has beams and is far enough from the previous one.
  // `motion` is the odometry since the last call.
  bool add(const WallObservation& observation, const OdometryIncrement& motion);

  const std::deque<PastMeasurement>& measurements() const { return measurements_; }
  std::size_t beam_stride() const { return settings_.beam_stride; }
  // The pose at the time of a past observation of a vehicle that is at `now`, by odometry whose
  // distances are multiplied by `odometry_scale`.
  Pose2 pose_at(const Pose2& now, double odometry_scale, const PastMeasurement& past) const;

 private:
  MeasurementWindowSettings settings_;
  Pose2 driven_;
  double driven_m_ = 0;
  double since_last_m_ = 0;
  std::deque<PastMeasurement> measurements_;  // the oldest first
};

}  // namespace milepost
