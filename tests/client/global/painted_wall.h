// Images of a wall across the driving direction, for tests of a moving camera.
#pragma once

#include <opencv2/core.hpp>

#include "schema/geo/camera.h"

namespace milepost::testing {

inline constexpr Pinhole kView{360, 360, 300, 250};
inline const Camera kCamera{600, 500, kView};
inline constexpr double kWallM = 14;  // distance in front of the first camera

// A wall with upright rectangles of all sizes, 60 m wide and 40 m high.
cv::Mat painted_wall();

// The wall as seen by a camera that drove ahead by `ahead_m`, turned right by `turn_rad` and then
// looks up by `pitch_rad`.
cv::Mat seen(const cv::Mat& wall, double ahead_m, double turn_rad, double pitch_rad = 0);

}  // namespace milepost::testing
