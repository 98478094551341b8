// The observations of a tracklet, and tiles that store all of them.
// The tracklet paper, section 3.1.1, Eq. 1.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "schema/base/range.h"
#include "schema/feature/types.h"
#include "schema/tile/tracklet.h"

namespace milepost {

// The paper's g_m, Eq. 1: one feature of one frame.
struct Observation {
  Feature feature;        // p_m, s_m
  Descriptor descriptor;  // u_m
  double along_m = 0;     // l_m
};

// The paper's T, Eq. 1: observations in consecutive frames, in driving order.
using Track = std::vector<Observation>;

struct ObservedTracklet {
  Tracklet tracklet;
  Track track;
};

// Sets the fields of a tracklet that do not come from the regression: mean descriptor, ranges and
// count. REQUIRES: a track that is not empty.
void set_from_track(const Track& track, Tracklet& tracklet);

// The tracklets whose first observation lies in [index, index + 1) * tile length of one segment.
struct ObservationTile {
  std::string segment;
  std::uint32_t index = 0;
  ScaleModel model = ScaleModel::inverse_scale;
  std::vector<ObservedTracklet> tracklets;
};

}  // namespace milepost
