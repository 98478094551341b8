// Walls as a tile can keep them (FORMAT.md 6.4).
#pragma once

#include <vector>

#include "schema/base/result.h"
#include "schema/tile/wall.h"

namespace milepost {

// The walls cut as their tiles ask for, in the steps of a tile, sorted, each once; those without
// length are left out. A wall is the shorter geodesic between its ends. Across longitude 180 it
// becomes two, one on either side (RFC 7946, 3.1.9); one that spans more than 0.1 degrees of
// longitude, as near a pole, becomes several, and what lies within a metre of a pole is lost. All
// others keep their ends. Errors: invalid_input (an end that is no place on the
// Earth; more than a million pieces too many).
Result<std::vector<Wall>> storable_walls(const std::vector<Wall>& walls);

}  // namespace milepost
