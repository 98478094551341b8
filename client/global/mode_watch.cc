#include "client/global/mode_watch.h"

#include <algorithm>
#include <cmath>

namespace milepost {
namespace {

constexpr double kLatelyRate = 0.1;  // of what is new in a frame
constexpr double kUsuallyRate = 0.01;
constexpr double kDoubtBelow = 0.6;  // of the usual

}  // namespace

const char* name_of(FindStatus status) {
  switch (status) {
    case FindStatus::initializing:
      return "initializing";
    case FindStatus::tracking:
      return "tracking";
    case FindStatus::predicted:
      return "predicted";
    case FindStatus::lost:
      return "lost";
  }
  return "";
}

void ModeWatch::drive(const WheelMotion& motion) {
  const Turned before = turns_.empty() ? Turned{} : turns_.back();
  turns_.push_back(
      {before.driven_m + std::abs(motion.distance_m), before.turned_rad + motion.turn_rad});
  const double since_m = turns_.back().driven_m - settings_.found_straight_m;
  while (turns_.front().driven_m < since_m) turns_.pop_front();
}

bool ModeWatch::has_bend() const {
  const auto [least, most] = std::ranges::minmax(turns_, {}, &Turned::turned_rad);
  return most.turned_rad - least.turned_rad >= settings_.found_bend_rad;
}

bool ModeWatch::is_enough() const {
  const double enough_m = has_bend() ? settings_.found_way_m : settings_.found_straight_m;
  return held_.way_m >= enough_m && held_.explained_m >= settings_.found_explained * held_.way_m;
}

FindStatus ModeWatch::observe(const BeliefMode& mode, std::optional<double> explained,
                              bool is_rivalled, const WheelMotion& motion) {
  drive(motion);
  if (explained) {
    lately_ += kLatelyRate * (*explained - lately_);
    usually_ += kUsuallyRate * (*explained - usually_);
  }
  const bool stays =
      place_ &&
      (moved(*place_, motion.distance_m, motion.turn_rad).enu_m - mode.pose.enu_m).norm() <=
          settings_.place_m;
  place_ = mode.pose;
  const double least_mass = found_ ? settings_.kept_mass : settings_.found_mass;
  const bool holds = stays && mode.mass >= least_mass && lately_ >= settings_.kept_explained;
  if (!holds) held_ = {};
  if (holds && explained) {
    held_.way_m += std::abs(motion.distance_m);
    held_.explained_m += std::abs(motion.distance_m) * *explained;
  }
  found_ = holds && (found_ || (is_enough() && !is_rivalled));
  was_found_ = was_found_ || found_;
  if (!found_) return was_found_ ? FindStatus::lost : FindStatus::initializing;
  return explained ? FindStatus::tracking : FindStatus::predicted;
}

bool ModeWatch::is_doubtful() const { return lately_ < kDoubtBelow * usually_; }

}  // namespace milepost
