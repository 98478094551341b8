// The odometry noise of our global localization method (decision 22).
#pragma once

#include "client/global/particle_set.h"
#include "schema/geo/geodesy.h"

namespace milepost {

inline constexpr MotionNoise kOdometryNoise{0.1, 0.03, 1 * kRadPerDeg, 0.0015};
inline constexpr double kOdometryScaleSigma = 0.02;  // initial

}  // namespace milepost
