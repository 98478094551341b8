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
// The limits lie on either side of the middle between lanes up to 4 m wide and streets from 8 m
// apart, so that a slow difference of 1.5 m between drives misleads neither.
struct SameRoadSettings {
  RoadLimits surely{5, 10, 2.5};
  RoadLimits may{6.5, 45, 4};
  double smooth_m = 10;      // distances and turns are means over this length
  double min_length_m = 10;  // of all that is surely together in a stretch
  double max_gap_m = 15;  // a stretch holds over a shorter part in which they may not be together
};

// The parts of alignments on one road, each trimmed to it.
std::vector<Alignment> same_road(const std::vector<Alignment>& alignments,
                                 const SameRoadSettings& settings);

}  // namespace milepost
