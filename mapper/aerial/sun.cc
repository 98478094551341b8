#include "mapper/aerial/sun.h"

#include <cmath>

#include "schema/geo/geodesy.h"

namespace milepost {

Eigen::Vector2d shadow_direction(const Sun& sun) {
  const double azimuth_rad = sun.azimuth_deg * kRadPerDeg;
  return {-std::sin(azimuth_rad), -std::cos(azimuth_rad)};
}

}  // namespace milepost
