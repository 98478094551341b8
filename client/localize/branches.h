// How a hypothesis goes on at the end of its segment.
#pragma once

#include <vector>

#include "client/fetch/held_map.h"
#include "client/localize/hypothesis.h"

namespace milepost {

// Whether a pose beyond an end of its segment is on a segment that continues it.
bool leads_on(const Hypothesis& hypothesis, const TrackedPose& pose, const HeldMap& held);

// Of a method that knows the arc length only: the hypothesis on each branch, once its pose is
// beyond the end of its segment. Empty before, and for methods that follow the road by themselves.
std::vector<Hypothesis> branches_of(const Hypothesis& hypothesis, const TrackedPose& pose,
                                    const HeldMap& held);

}  // namespace milepost
