// The sequential probability ratio test of one hypothesis against "elsewhere": another position on
// the map, or none.
#pragma once

#include <optional>

#include "schema/base/range.h"

namespace milepost {

struct LogOddsSettings {
  // All in natural logarithms of odds.
  double first = -3;         // prior of a hypothesis
  double max_for = 6;        // largest change in favour, per frame ...
  double max_against = 4.6;  // ... and against: an occlusion also contradicts
  double claim = 6;          // threshold of acceptance; ...
  double hold = 4.5;         // ... down to which it counts as tracking; ...
  double doubt = 2;          // ... upper bound after a frame that contradicts it; ...
  double give_up = 0;        // ... below which it is rejected
  // Consecutive frames see the same landmarks: evidence in favour counts in proportion to the
  // distance from where it was counted before, fully at this distance, and as far as it exceeds
  // what was counted of the frames before. A pose that jitters about one place goes nowhere.
  // Evidence against counts fully from this log Bayes factor on, and in proportion to it, or to the
  // distance, below.
  double novel_m = 5;
  double strongly_against = 3;
  // Probability that the vehicle leaves the map or the belief slips within novel_m. Bounds the
  // odds.
  double lapse = 0.004;
};

class LogOdds {
 public:
  explicit LogOdds(const LogOddsSettings& settings) : settings_(settings), log_(settings.first) {}

  // Lets the odds lapse with the distance travelled.
  void move(double by_m);
  // Adds the log Bayes factor of a frame taken at along_m; `best` is the highest one of that frame
  // over all hypotheses.
  void add_frame(double log_bayes_factor, double best, double along_m);
  // Adds the log Bayes factor of independent evidence.
  void add(double log_bayes_factor) { log_ += log_bayes_factor; }

  double log() const { return log_; }

 private:
  // How far a frame taken at along_m is beyond those in favour: [0, 1].
  double novelty(double along_m) const;
  void remember(double along_m);

  LogOddsSettings settings_;
  double log_;
  std::optional<AlongRange> seen_from_;  // arc lengths of the latest frames in favour
  double counted_ = 0;                   // of the evidence in favour from there
};

}  // namespace milepost
