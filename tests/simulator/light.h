// The light over a town at one hour of one day.
#pragma once

#include <cstdint>

#include "tests/simulator/scene.h"

namespace milepost::simulator {

struct Light {
  double sun_azimuth_deg = 140;  // of the sun, clockwise from north
  double sun_elevation_deg = 42;
  cv::Vec3f sun{1.02F, 1.16F, 1.28F};     // blue, green, red on a surface that faces the sun
  cv::Vec3f sky{0.42F, 0.36F, 0.31F};     // under an open sky
  cv::Vec3f bounce{0.13F, 0.14F, 0.15F};  // from sunlit ground and walls, everywhere
  float cloud_cover = 0.45F;              // share of the sky that is clouded, [0, 1]
  std::uint64_t clouds_seed = 1;
  float haze_per_m = 0.0007F;

  Point to_sun() const;  // a unit vector
};

// The light at the times of day of the drives.
Light morning_light();    // low sun from the east
Light noon_light();       // high sun, the mapping drive's
Light afternoon_light();  // two hours later
Light overcast_light();   // hardly a shadow

}  // namespace milepost::simulator
