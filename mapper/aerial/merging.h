// Segments that are one line in truth (the aerial paper, section II).
#pragma once

#include "mapper/aerial/wall_line.h"

namespace milepost {

struct MergingSettings {
  double max_angle_deg = 6;  // between two segments of one line
  double max_apart_m = 0.4;  // of the shorter one's ends from the longer one's line
  double max_gap_m = 0.8;    // between their ends, along the line
};

// Segments that are almost parallel and near each other become one, from end to end; the longest
// gathers first. The lines come the longest first, in the sense of their longest part.
// REQUIRES: no line has length 0.
WallLines merged(WallLines lines, const MergingSettings& settings);

}  // namespace milepost
