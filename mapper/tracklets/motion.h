// Predicts where a followed feature appears next.
#pragma once

#include "schema/tile/observation.h"

namespace milepost {

struct PredictedPosition {
  float x_px = 0;
  float y_px = 0;
  float motion_px = 0;  // length of the predicted motion from the latest observation
};

// Continues the motion between the track's last two observations to `along_m`. Under straight
// motion towards a fixed point the image motion grows as the inverse of depth, and depth shrinks as
// scale grows. REQUIRES: two observations or more.
PredictedPosition predict_position(const Track& track, double along_m);

}  // namespace milepost
