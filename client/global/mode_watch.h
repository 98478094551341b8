// When a belief is a finding: one place carries it, and goes where the wheels go, and explains what
// is seen, for some way.
#pragma once

#include <deque>
#include <optional>

#include "client/global/mean_shift.h"
#include "client/global/plan_pose.h"

namespace milepost {

enum class FindStatus {
  initializing,  // no place carries the belief yet
  tracking,      // one does, and this frame was weighed
  predicted,     // one does, carried on by the wheels: this frame told nothing
  lost,          // one did, and does no more
};

const char* name_of(FindStatus status);

struct WatchSettings {
  double found_mass = 0.9;        // of the mode, to be found
  double found_explained = 0.65;  // of what was seen while it held
  double found_way_m = 40;        // so far both must hold, in one place, if there was a bend
  double found_bend_rad = 0.8;    // so much of a turn, within the last found_straight_m
  double found_straight_m = 80;   // ... or so far without: one straight street looks like another
  double kept_mass = 0.5;         // to stay found
  double kept_explained = 0.2;    // of what is seen lately, also while it is not yet found
  double place_m = 5;             // a mode that jumps farther is another place
};

class ModeWatch {
 public:
  explicit ModeWatch(const WatchSettings& settings) : settings_(settings) {}

  // `explained`: the share of what the frame shows that the walls about the mode explain; none if
  // it shows nothing. `is_rivalled`: another place explains the way behind nearly as well.
  FindStatus observe(const BeliefMode& mode, std::optional<double> explained, bool is_rivalled,
                     const WheelMotion& motion);

  bool is_found() const { return found_; }
  bool was_found() const { return was_found_; }
  double explained() const { return lately_; }
  // Whether the mode explains much less than it used to (as the augmented filter of Thrun, Burgard
  // and Fox notices it, Probabilistic Robotics, 2005, Table 8.3).
  bool is_doubtful() const;

 private:
  // The way over which one place held, without that on which nothing was seen.
  struct Held {
    double way_m = 0;
    double explained_m = 0;
  };
  struct Turned {
    double driven_m = 0;
    double turned_rad = 0;  // since the start of the drive
  };

  void drive(const WheelMotion& motion);
  bool has_bend() const;
  bool is_enough() const;

  WatchSettings settings_;
  std::optional<PlanPose> place_;
  Held held_;
  std::deque<Turned> turns_;  // of the last found_straight_m, the oldest first
  double lately_ = 0;
  double usually_ = 0;
  bool found_ = false;
  bool was_found_ = false;
};

}  // namespace milepost
