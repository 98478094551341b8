// A feature followed over consecutive frames, before it is reduced to a tracklet.
#pragma once

#include <vector>

#include "schema/feature/types.h"

namespace milepost {

// The tracklet paper's g_m, Eq. 1: one feature of one frame.
struct Observation {
  Feature feature;        // p_m, s_m
  Descriptor descriptor;  // u_m
  double along_m = 0;     // l_m
};

// The tracklet paper's T, Eq. 1: observations in consecutive frames, in the order they were driven.
using Track = std::vector<Observation>;

}  // namespace milepost
