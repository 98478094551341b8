// Prepares walls for storage in tiles (FORMAT.md 6.4).
#pragma once

#include <vector>

#include "schema/base/result.h"
#include "schema/tile/wall.h"

namespace milepost {

// The walls, cut to the limits of tiles, quantized, sorted, without duplicates and without walls of
// zero length. A wall is the shorter geodesic between its ends. Across longitude 180 it becomes
// two, one on either side (RFC 7946, 3.1.9); one that spans more than 0.1 degrees of longitude, as
// near a pole, becomes several, and parts within a metre of a pole are lost. All others keep their
// ends. Errors: invalid_input (an end that is not a position on the Earth; more than a million
// additional pieces).
Result<std::vector<Wall>> storable_walls(const std::vector<Wall>& walls);

}  // namespace milepost
