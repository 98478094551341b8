// A GNSS fix: the position prior of a vehicle.
#pragma once

#include <optional>

#include "schema/geo/geodesy.h"

namespace milepost {

// A position from a GNSS receiver, or from global localization.
struct GnssFix {
  double timestamp_s = 0;
  GeoPoint position;
  double sigma_m = 0;  // one standard deviation per axis
  // Heading of the vehicle, clockwise from north, if known to about 30 degrees: segments that lead
  // elsewhere are not considered for a start.
  std::optional<double> heading_deg = {};
};

}  // namespace milepost
