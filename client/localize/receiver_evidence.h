// What a receiver of satellite signals says for a place and against it.
#pragma once

#include <optional>

#include "client/localize/coarse_position.h"
#include "schema/geo/geodesy.h"

namespace milepost {

struct ReceiverEvidenceSettings {
  // Its error lasts: a reading is a new witness as far as time has passed since the one counted
  // before, or as far as it has moved against the place.
  double correlation_s = 10;
  double moved_sigmas = 3;
  double degrees = 3;           // of freedom of Student's t: receivers are at times far off
  double elsewhere_sigmas = 2;  // off a reading that says nothing
  double max_against = 4.6;     // of one reading
  double speed_mps = 20;        // how fast a reading grows old
};

// The logarithm of how much more likely readings are where the camera is than elsewhere, for one
// place; each reading once, and as far as it is independent of the one counted before.
class ReceiverEvidence {
 public:
  explicit ReceiverEvidence(const ReceiverEvidenceSettings& settings) : settings_(settings) {}

  double log_bayes_factor(const CoarsePosition& reading, const GeoPoint& place, double now_s);

 private:
  struct Counted {
    double timestamp_s = 0;
    EnuPoint off;  // from the place to the reading
  };

  ReceiverEvidenceSettings settings_;
  std::optional<Counted> counted_;  // the reading counted last
};

}  // namespace milepost
