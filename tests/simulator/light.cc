#include "tests/simulator/light.h"

#include <cmath>
#include <numbers>

namespace milepost::simulator {

Point Light::to_sun() const {
  const double azimuth = sun_azimuth_deg * std::numbers::pi / 180;
  const double elevation = sun_elevation_deg * std::numbers::pi / 180;
  return {std::sin(azimuth) * std::cos(elevation), std::cos(azimuth) * std::cos(elevation),
          std::sin(elevation)};
}

Light morning_light() {
  Light light;
  light.sun_azimuth_deg = 105;
  light.sun_elevation_deg = 31;
  light.sun = {0.88F, 1.12F, 1.32F};
  light.cloud_cover = 0.3F;
  light.clouds_seed = 2;
  light.haze_per_m = 0.0012F;
  return light;
}

Light noon_light() {
  Light light;
  light.sun_azimuth_deg = 165;
  light.sun_elevation_deg = 52;
  return light;
}

Light afternoon_light() {
  Light light = noon_light();
  light.sun_azimuth_deg = 193;
  light.sun_elevation_deg = 47;
  light.sun = {0.98F, 1.15F, 1.29F};
  light.clouds_seed = 3;
  return light;
}

Light overcast_light() {
  Light light;
  light.sun_azimuth_deg = 200;
  light.sun_elevation_deg = 45;
  light.sun = {0.16F, 0.17F, 0.17F};
  light.sky = {0.86F, 0.84F, 0.80F};
  light.cloud_cover = 1;
  light.clouds_seed = 4;
  light.haze_per_m = 0.0016F;
  return light;
}

}  // namespace milepost::simulator
