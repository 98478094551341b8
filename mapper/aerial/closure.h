// The model of a building as a closed outline (the aerial paper, section II).
#pragma once

#include "mapper/aerial/wall_line.h"

namespace milepost {

struct ClosureSettings {
  double reach_m = 2.5;  // ends this near are of one corner
  int min_ends = 1;      // of a line's two ends, that must be at the end of another line
};

// Leaves out lines whose ends are near no other line's end, again and again until all are left that
// stand. The others stay in their order.
WallLines closed(WallLines lines, const ClosureSettings& settings);

}  // namespace milepost
