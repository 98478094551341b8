// The position of the sun when a picture was taken.
#pragma once

#include <Eigen/Core>

namespace milepost {

struct Sun {
  double azimuth_deg = 180;   // of the sun, clockwise from north
  double elevation_deg = 45;  // above the horizon
};

// The direction in which shadows fall, east and north, of length 1.
Eigen::Vector2d shadow_direction(const Sun& sun);

}  // namespace milepost
