// Removes lines that are covered by known ones.
#pragma once

#include "mapper/aerial/wall_line.h"

namespace milepost {

struct CoverageSettings {
  double reach_m = 1.5;       // of a known line to either side
  double max_angle_deg = 15;  // between a line and a known one
  double min_share = 0.5;     // of a line's length that must be covered
};

// The lines that `known` does not cover, in their order. REQUIRES: no line has length 0.
WallLines not_covered(const WallLines& lines, const WallLines& known,
                      const CoverageSettings& settings);

}  // namespace milepost
