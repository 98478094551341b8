// Decides where aligned ways are on one road: lanes of a road are, parallel streets are not.
#pragma once

#include <vector>

#include "mapper/network/alignment.h"

namespace milepost {

// What two states on one cross-section may differ by.
struct RoadLimits {
  double apart_m = 0;   // between lines of driving
  double turn_deg = 0;  // between directions
  double climb_m = 0;   // between altitudes, where both ways have them
};

// Hysteresis with two limits, as by which Canny (1986) follows edges: a stretch of the same road
// begins and ends where the ways are surely together, and holds in between while they may be.
// Lanes are up to 4 m apart and parallel streets 8 m and more: a difference of 1.5 m between two
// drives, or a bias of 2.5 m in one, misleads neither way.
struct SameRoadSettings {
  RoadLimits surely{5.5, 10, 2.5};
  RoadLimits may{7, 45, 4};
  double smooth_m = 10;          // distances and turns are means over this length
  double min_surely_m = 10;      // of a stretch ...
  double min_surely_part = 0.5;  // ... and of its length
  double max_gap_m = 15;  // a stretch holds over a shorter part in which they may not be together
};

// The parts of alignments on one road, each trimmed to it.
std::vector<Alignment> same_road(const std::vector<Alignment>& alignments,
                                 const SameRoadSettings& settings);

}  // namespace milepost
