// The fix that tells a hypothesis.
#pragma once

#include <optional>
#include <vector>

#include "client/localize/fix.h"
#include "client/localize/hypothesis.h"

namespace milepost {

inline constexpr double kElsewhereM = 5;  // minimum sigma of "elsewhere" ...
inline constexpr double kUnknownM = 30;   // ... and its sigma without a GNSS fix

Fix unlocated(double timestamp_s, FixStatus status);

// The fix of a hypothesis at its last frame.
Fix fix_of(const Hypothesis& hypothesis, FixStatus status);
// The fix of a hypothesis with its pose at another time.
Fix fix_of(const Hypothesis& hypothesis, const TrackedPose& pose, double timestamp_s,
           FixStatus status);

// Fills in the pose that the motion has carried a hypothesis to, off the map. REQUIRES: its tracker
// knows the full pose.
void carry_on(Fix& fix, const Hypothesis& hypothesis, double timestamp_s);

// Widens the sigmas of an uncertain hypothesis to cover all hypotheses and "elsewhere", which is at
// the GNSS fix if there is one. `log_odds` are the hypothesis' against elsewhere.
void widen(Fix& fix, double log_odds, const Hypothesis& hypothesis,
           const std::vector<Hypothesis>& hypotheses, const std::optional<GnssFix>& reading);

}  // namespace milepost
