// Completion of building corners, which detected edges rarely reach.
#pragma once

#include "mapper/aerial/wall_line.h"

namespace milepost {

struct CornerSettings {
  double reach_m = 2;         // largest distance from a line's end to its corner
  double min_angle_deg = 30;  // between the two lines of a corner
};

// Moves the ends of two lines that nearly meet to the intersection of the lines, the closest pairs
// first; each end is moved at most once. The lines stay in their order.
WallLines with_corners(WallLines lines, const CornerSettings& settings);

}  // namespace milepost
