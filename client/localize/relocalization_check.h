// Checks the pose of a tracked hypothesis by relocalizing from time to time without the belief.
#pragma once

#include <vector>

#include "client/localize/hypothesis.h"

namespace milepost {

// A belief that has slipped to a wrong pose supported by a part of the frame stays there, since
// guided matching searches landmarks where the belief predicts them and distant ones fit many
// poses. An independent pose detects this.
class RelocalizationCheck {
 public:
  // At every frame at first and while the pose is uncertain, then every few metres.
  bool is_due(double way_m) const;
  // The camera calibration for relocalization: the given one (none) at first and while the pose is
  // uncertain, since an estimate may then be as wrong as the pose; later the estimated one.
  std::optional<LearnedCamera> camera(const Hypothesis& hypothesis) const;
  // Compares the tracked pose with poses found independently of its belief. If another pose has
  // about as many inliers, the hypothesis is uncertain by their distance (`apart_m`) for some
  // checks; if it has more, twice in a row, the belief is replaced by it.
  void compare(Hypothesis& hypothesis, std::vector<RelocalizationCandidate> candidates);

 private:
  int looks_ = 0;
  double looked_from_m_ = 0;
  int against_ = 0;     // consecutive contradicting checks
  double apart_m_ = 0;  // distance of the latest alternative ...
  int calm_ = 0;        // ... and number of checks since
};

}  // namespace milepost
