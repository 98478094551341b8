// Predicts the next position of a tracked feature.
#pragma once

#include "schema/tile/observation.h"

namespace milepost {

struct PredictedPosition {
  float x_px = 0;
  float y_px = 0;
  float motion_px = 0;  // length of the predicted motion from the latest observation
};

// Extrapolates the motion between the track's last two observations to `along_m`. Under straight
// motion towards a fixed point the image motion grows as the inverse of depth, and depth is
// inversely proportional to scale. REQUIRES: two or more observations.
PredictedPosition predict_position(const Track& track, double along_m);

}  // namespace milepost
