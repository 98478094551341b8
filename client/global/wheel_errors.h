// How wheels err, for our way of finding a vehicle (decision 22).
#pragma once

#include "client/global/particle_cloud.h"
#include "schema/geo/geodesy.h"

namespace milepost {

inline constexpr MotionNoise kWheelNoise{0.1, 0.03, 1 * kRadPerDeg, 0.0015};
inline constexpr double kWheelScaleSigma = 0.02;  // before anything is seen

}  // namespace milepost
