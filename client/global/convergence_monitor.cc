#include "client/global/convergence_monitor.h"

#include <algorithm>
#include <cmath>

namespace milepost {
namespace {

constexpr double kLatelyRate = 0.1;    // weight of a frame in the recent average
constexpr double kUsuallyRate = 0.01;  // ... and in the long-term average
constexpr double kDoubtBelow = 0.6;    // of the long-term average

}  // namespace

const char* name_of(GlobalStatus status) {
  switch (status) {
    case GlobalStatus::initializing:
      return "initializing";
    case GlobalStatus::tracking:
      return "tracking";
    case GlobalStatus::predicted:
      return "predicted";
    case GlobalStatus::lost:
      return "lost";
  }
  return "";
}

void ConvergenceMonitor::drive(const OdometryIncrement& motion) {
  const Turned before = turns_.empty() ? Turned{} : turns_.back();
  turns_.push_back(
      {before.driven_m + std::abs(motion.distance_m), before.turned_rad + motion.turn_rad});
  const double since_m = turns_.back().driven_m - settings_.min_found_straight_m;
  while (turns_.front().driven_m < since_m) turns_.pop_front();
}

bool ConvergenceMonitor::has_bend() const {
  const auto [least, most] = std::ranges::minmax(turns_, {}, &Turned::turned_rad);
  return most.turned_rad - least.turned_rad >= settings_.min_found_bend_rad;
}

bool ConvergenceMonitor::is_enough() const {
  const double enough_m =
      has_bend() ? settings_.min_found_distance_m : settings_.min_found_straight_m;
  return held_.distance_m >= enough_m &&
         held_.inlier_m >= settings_.min_found_inlier_ratio * held_.distance_m;
}

GlobalStatus ConvergenceMonitor::observe(const BeliefMode& mode, std::optional<double> inlier_ratio,
                                         bool has_alternative, const OdometryIncrement& motion) {
  drive(motion);
  if (inlier_ratio) {
    lately_ += kLatelyRate * (*inlier_ratio - lately_);
    usually_ += kUsuallyRate * (*inlier_ratio - usually_);
  }
  const bool stays =
      place_ &&
      (moved(*place_, motion.distance_m, motion.turn_rad).enu_m - mode.pose.enu_m).norm() <=
          settings_.place_m;
  place_ = mode.pose;
  const double min_probability =
      found_ ? settings_.min_kept_probability : settings_.min_found_probability;
  const bool holds =
      stays && mode.probability >= min_probability && lately_ >= settings_.min_kept_inlier_ratio;
  if (!holds) held_ = {};
  if (holds && inlier_ratio) {
    held_.distance_m += std::abs(motion.distance_m);
    held_.inlier_m += std::abs(motion.distance_m) * *inlier_ratio;
  }
  found_ = holds && (found_ || (is_enough() && !has_alternative));
  was_found_ = was_found_ || found_;
  if (!found_) return was_found_ ? GlobalStatus::lost : GlobalStatus::initializing;
  return inlier_ratio ? GlobalStatus::tracking : GlobalStatus::predicted;
}

bool ConvergenceMonitor::is_doubtful() const { return lately_ < kDoubtBelow * usually_; }

}  // namespace milepost
