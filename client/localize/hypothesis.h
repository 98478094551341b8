// Hypotheses of the camera's position, tested against each other and against "elsewhere": another
// position on the map, or none.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "client/fetch/segment_layer.h"
#include "client/localize/gnss_fix.h"
#include "client/localize/gnss_likelihood.h"
#include "client/localize/log_odds.h"
#include "client/localize/segment_tracker.h"

namespace milepost {

inline constexpr double kEndMarginM = 5;  // tolerance beyond a segment's ends

inline constexpr double kSameHypothesisM = 4;  // hypotheses closer than this are merged
inline constexpr double kAgreedM = 0.5;        // ... and independently found poses agree

// Whether a pose is not farther beside the line than any lane. Methods that do not know say yes.
bool is_on_road(const TrackedPose& pose);

// What has been found of a hypothesis.
struct HypothesisRecord {
  LogOdds odds;
  GnssLikelihood receiver;
  double timestamp_s = 0;       // of the last frame
  bool measured = false;        // whether it was measured
  double log_bayes_factor = 0;  // of the last frame
  int matches = 0;
  bool contradicted = false;  // by the last frame
  bool weighed = false;       // whether the last frame is included in the odds
  // The way driven is the arc length plus this: that of segments driven before.
  double way_before_m = 0;
  // Distance to an independently found pose with about as many inliers in the last frame, in
  // metres; 0 if there is none.
  double apart_m = 0;
  bool was_tracked = false;  // until it was lost
};

// One hypothesis: a pose that is tracked, and its odds against "elsewhere".
struct Hypothesis : HypothesisRecord {
  std::unique_ptr<SegmentTracker> tracker;

  const SegmentLayer& layer() const { return *tracker->layer(); }
  GeoPoint position() const;
  // Whether a pose is on the hypothesis' segment: on its road, and not beyond an end of it.
  bool is_on_segment(const TrackedPose& pose) const;

  // Whether it was tracked, and its motion tells to some 10 m that it has come to this pose on its
  // segment.
  bool is_carried(const TrackedPose& pose) const;

  double way_m() const { return tracker->pose().along_m + way_before_m; }

  // Tracks to the next frame.
  TrackingResult advance(SharedFrame& frame);
  // The same hypothesis on a successor, for methods that know the arc length only; none for others.
  std::optional<Hypothesis> continued_on(const std::shared_ptr<const SegmentLayer>& successor,
                                         double begin_m) const;
  // Updates the odds with the last frame and, if given, a GNSS fix. `best` is the highest log Bayes
  // factor of the frame over all hypotheses.
  void weigh(double best, const std::optional<GnssFix>& reading);
};

// Updates the odds of all hypotheses with the last frame and the GNSS fix. Equal hypotheses are
// merged, those beyond `most` and unlikely ones are dropped, but not one that was tracked while its
// motion tells well where it is; the most likely comes first. Returns the unlikely ones.
std::vector<Hypothesis> weigh(std::vector<Hypothesis>& hypotheses,
                              const std::optional<GnssFix>& reading, std::size_t most);

// The log odds of the first hypothesis against all others and elsewhere. REQUIRES: there is one.
double log_odds_of_first(const std::vector<Hypothesis>& hypotheses);

// The log Bayes factor, for a hypothesis against elsewhere, of the motion since another one left
// the map. On the segment that was left it may be large against: the map may look the same there as
// beyond its end. On others it is bounded, as the motion is carried on without a measurement; 0
// there for methods that know the arc length only.
double log_bayes_factor_after(const Hypothesis& left, const Hypothesis& hypothesis);

}  // namespace milepost
