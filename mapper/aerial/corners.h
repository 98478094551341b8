// Corners of buildings, which edges seldom reach.
#pragma once

#include "mapper/aerial/wall_line.h"

namespace milepost {

struct CornerSettings {
  double reach_m = 2;         // of a line's end from the corner that it is led to
  double min_angle_deg = 30;  // between the two lines of a corner
};

// Leads the ends of two lines that all but meet to the point where the lines cross, the closest
// pairs first; each end is moved once. The lines stay in their order.
WallLines with_corners(WallLines lines, const CornerSettings& settings);

}  // namespace milepost
