#include "client/find/mode_watch.h"

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

FindStatus ModeWatch::observe(const BeliefMode& mode, std::optional<double> explained,
                              const WheelMotion& motion) {
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
  const double least_explained = found_ ? settings_.kept_explained : settings_.found_explained;
  const bool holds = stays && mode.mass >= least_mass && lately_ >= least_explained;
  way_m_ = holds ? way_m_ + std::abs(motion.distance_m) : 0;
  turn_rad_ = holds ? turn_rad_ + motion.turn_rad : 0;
  has_bend_ = holds && (has_bend_ || std::abs(turn_rad_) >= settings_.found_bend_rad);
  found_ = holds &&
           (found_ || way_m_ >= (has_bend_ ? settings_.found_way_m : settings_.found_straight_m));
  was_found_ = was_found_ || found_;
  if (!found_) return was_found_ ? FindStatus::lost : FindStatus::initializing;
  return explained ? FindStatus::tracking : FindStatus::predicted;
}

bool ModeWatch::is_doubtful() const { return lately_ < kDoubtBelow * usually_; }

}  // namespace milepost
