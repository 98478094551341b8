// Decides whether the belief has converged: one mode holds most of the probability, moves as
// odometry predicts, and explains the measurements over some distance.
#pragma once

#include <deque>
#include <optional>

#include "client/global/mean_shift.h"
#include "client/global/pose2.h"

namespace milepost {

enum class GlobalStatus {
  initializing,  // not converged to one mode yet
  tracking,      // converged; this frame gave a measurement
  predicted,     // converged; propagated by odometry: this frame gave no measurement
  lost,          // was converged, is no longer
};

const char* name_of(GlobalStatus status);

struct ConvergenceSettings {
  double min_found_probability = 0.9;    // of the mode, to converge
  double min_found_inlier_ratio = 0.65;  // over the distance for which the mode has held
  double min_found_distance_m = 40;      // distance for which both must hold, if there was a bend
  double min_found_bend_rad = 0.8;       // size of a bend, within the last min_found_straight_m
  double min_found_straight_m = 80;      // ... the distance without one: straight streets are alike
  double min_kept_probability = 0.5;     // of the mode, to stay converged
  double min_kept_inlier_ratio = 0.2;    // recent average, also before convergence
  double place_m = 5;                    // a mode that jumps farther is another one
};

class ConvergenceMonitor {
 public:
  explicit ConvergenceMonitor(const ConvergenceSettings& settings) : settings_(settings) {}

  // `inlier_ratio`: the share of the frame's measurements that the walls explain at the mode; none
  // without measurements. `has_alternative`: another hypothesis explains the window nearly as well.
  GlobalStatus observe(const BeliefMode& mode, std::optional<double> inlier_ratio,
                       bool has_alternative, const OdometryIncrement& motion);

  bool is_found() const { return found_; }
  bool was_found() const { return was_found_; }
  double inlier_ratio() const { return lately_; }
  // Whether the recent inlier ratio is much lower than the long-term one (as detected by the
  // augmented filter of Thrun, Burgard and Fox, Probabilistic Robotics, 2005, Table 8.3).
  bool is_doubtful() const;

 private:
  // The distance for which one mode has held, without stretches without measurements.
  struct Held {
    double distance_m = 0;
    double inlier_m = 0;
  };
  struct Turned {
    double driven_m = 0;
    double turned_rad = 0;  // since the start of the drive
  };

  void drive(const OdometryIncrement& motion);
  bool has_bend() const;
  bool is_enough() const;

  ConvergenceSettings settings_;
  std::optional<Pose2> place_;
  Held held_;
  std::deque<Turned> turns_;  // of the last min_found_straight_m, the oldest first
  double lately_ = 0;
  double usually_ = 0;
  bool found_ = false;
  bool was_found_ = false;
};

}  // namespace milepost
