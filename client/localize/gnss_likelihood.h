// The likelihood of GNSS fixes for a hypothesis.
#pragma once

#include <optional>

#include "client/localize/gnss_fix.h"
#include "schema/geo/geodesy.h"

namespace milepost {

struct GnssLikelihoodSettings {
  // GNSS errors are correlated in time: a fix counts in proportion to the time since the last
  // counted one, fully after `correlation_s`, or to its displacement relative to the hypothesis,
  // fully at `moved_sigmas`.
  double correlation_s = 10;
  double moved_sigmas = 3;
  double degrees = 3;           // of freedom of Student's t: GNSS outliers are large
  double elsewhere_sigmas = 2;  // distance from a fix at which it is neutral
  double max_against = 4.6;     // bound of the log Bayes factor against, per fix
  double speed_mps = 20;        // growth of a fix's sigma with its age
};

// The log Bayes factor of GNSS fixes for one hypothesis: "the camera is here" against "elsewhere".
// Each fix counts once, in proportion to its independence of the last counted one.
class GnssLikelihood {
 public:
  explicit GnssLikelihood(const GnssLikelihoodSettings& settings) : settings_(settings) {}

  double log_bayes_factor(const GnssFix& reading, const GeoPoint& place, double now_s);

 private:
  struct Counted {
    double timestamp_s = 0;
    EnuPoint off;  // from the hypothesis to the fix
  };

  GnssLikelihoodSettings settings_;
  std::optional<Counted> counted_;  // the last counted fix
};

}  // namespace milepost
