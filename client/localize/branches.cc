#include "client/localize/branches.h"

#include <algorithm>

#include "client/localize/unrolled_road.h"

namespace milepost {

bool leads_on(const Hypothesis& hypothesis, const TrackedPose& pose, const HeldMap& held) {
  const AlongRange around = AlongRange{pose.along_m, pose.along_m}.widened(kEndMarginM);
  const auto road = unrolled_road(held, hypothesis.tracker->layer(), around);
  return std::ranges::any_of(road, [](const UnrolledSegment& segment) {
    return segment.side == RoadSide::ahead || segment.side == RoadSide::behind;
  });
}

std::vector<Hypothesis> branches_of(const Hypothesis& hypothesis, const TrackedPose& pose,
                                    const HeldMap& held) {
  std::vector<Hypothesis> branches;
  constexpr double kWithinOverlapM = 2.5;  // frames of the map end with it
  const double length_m = hypothesis.layer().line.length_m();
  if (pose.along_m <= length_m - kWithinOverlapM) return branches;
  for (const UnrolledSegment& segment :
       unrolled_road(held, hypothesis.tracker->layer(), {length_m, length_m})) {
    if (segment.side != RoadSide::ahead || segment.junctions > 1) continue;
    if (pose.along_m <= std::min(length_m, segment.offset_m + kWithinOverlapM)) continue;
    if (auto there = hypothesis.continued_on(segment.layer, segment.offset_m))
      branches.push_back(std::move(*there));
  }
  return branches;
}

}  // namespace milepost
