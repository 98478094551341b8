// Starts: where near a position a frame may have been taken, found without a belief.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "client/fetch/held_map.h"
#include "client/localize/gnss_fix.h"
#include "client/localize/hypothesis.h"
#include "client/localize/localizer_settings.h"
#include "client/localize/recent_relocalizers.h"
#include "client/localize/shared_frame.h"

namespace milepost {

struct FoundNearby {
  // Distance of the nearest segment, infinite if none is near; none while unknown.
  std::optional<double> nearest_m;
  std::optional<Error> failure;  // why map data is missing
  std::vector<Hypothesis> hypotheses;
};

class NearbySearch {
 public:
  NearbySearch(const LocalizerSettings& settings, const Camera& camera)
      : settings_(settings), relocalizers_(settings.method, camera, settings.method_settings) {}

  // The circle in which segments may be the one that a position is on.
  Surroundings surroundings(const GnssFix& around) const;
  // The segments that are searched around a position, the nearest first; none while unknown.
  std::optional<std::vector<NearbySegment>> segments(const HeldMap& held,
                                                     const GnssFix& around) const;
  // What of a segment is searched: around its place that is nearest to a position.
  AlongRange range(double nearest_along_m, const GnssFix& around, double timestamp_s) const;

  // Hypotheses on segments near the position from which the frame may have been taken.
  FoundNearby search(SharedFrame& frame, const GnssFix& around);

  // Valid until the next call. Errors: the method's, where it cannot use the layer.
  Result<Relocalizer*> relocalizer_on(const std::shared_ptr<const SegmentLayer>& layer) {
    return relocalizers_.on(layer);
  }

 private:
  void search_on(SharedFrame& frame, const NearbySegment& where, const GnssFix& around,
                 FoundNearby& found);

  LocalizerSettings settings_;
  RecentRelocalizers relocalizers_;
};

}  // namespace milepost
