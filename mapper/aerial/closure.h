// Filter by the model of a building as a closed outline (the aerial paper, section II).
#pragma once

#include "mapper/aerial/wall_line.h"

namespace milepost {

struct ClosureSettings {
  double reach_m = 2.5;  // ends within this distance form a corner
  int min_ends = 1;      // of a line's two ends, how many must meet another line's end
};

// Removes lines whose ends are not near another line's end, until none is removed any more. The
// others stay in their order.
WallLines closed(WallLines lines, const ClosureSettings& settings);

}  // namespace milepost
