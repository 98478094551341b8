// The public summary of the map data held ahead.
#pragma once

#include <milepost/localizer.h>

#include <optional>

#include "client/fetch/held_map.h"
#include "client/fetch/wants.h"

namespace milepost::vehicle {

struct OnSegment {
  SegmentKey key;
  double along_m = 0;
};

// `from`: the position of the vehicle, if known.
MapAhead map_ahead_of(const HeldMap& held, const Wants& wants,
                      const std::optional<OnSegment>& from);

}  // namespace milepost::vehicle
