// Merging of segments that belong to one line (the aerial paper, section II).
#pragma once

#include "mapper/aerial/wall_line.h"

namespace milepost {

struct MergingSettings {
  double max_angle_deg = 6;  // between two segments of one line
  double max_apart_m = 0.4;  // of the shorter one's ends from the longer one's line
  double max_gap_m = 0.8;    // between their ends, along the line
};

// Merges segments that are almost parallel and near each other, greedily from the longest. The
// result is sorted by length, the longest first; each line has the direction of its longest part.
// REQUIRES: no line has length 0.
WallLines merged(WallLines lines, const MergingSettings& settings);

}  // namespace milepost
