// Where a receiver of satellite signals puts the vehicle.
#pragma once

#include <optional>

#include "schema/geo/geodesy.h"

namespace milepost {

// A coarse position, of a receiver of satellite signals.
struct CoarsePosition {
  double timestamp_s = 0;
  GeoPoint position;
  double sigma_m = 0;  // one standard deviation, in each direction
  // Where it is known which way the vehicle looks, clockwise from north, within 30 degrees or so:
  // segments that lead elsewhere are no place to start.
  std::optional<double> heading_deg = {};
};

}  // namespace milepost
