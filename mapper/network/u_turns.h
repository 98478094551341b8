// Finds where a vehicle turned round.
#pragma once

#include <vector>

#include "mapper/network/way.h"
#include "schema/base/range.h"

namespace milepost {

struct UTurnSettings {
  double min_turn_deg = 150;  // within `max_length_m`: an arc of less than 9.5 m radius
  double max_length_m = 25;
  double straight_deg = 20;  // the arc begins and ends where the direction differs by this
  // If other drives leave or join it this near to the arc, the arc begins or ends there.
  double max_approach_m = 20;
};

// The arcs of a way's U-turns, in driving order, disjoint.
std::vector<AlongRange> u_turns(const Way& way, const UTurnSettings& settings);

}  // namespace milepost
