// Where a belief puts the camera.
#pragma once

#include <optional>

#include "schema/geo/geodesy.h"

namespace milepost {

// What only some methods know.
struct Across {
  double lateral_m = 0;  // from the segment's line, positive to the right
  double lateral_sigma_m = 0;
  double heading_deg = 0;  // of the camera, clockwise from north, [0, 360)
  GeoPoint position;       // of the camera, beside the line
};

struct TrackedPosition {
  double along_m = 0;
  double sigma_m = 0;
  std::optional<Across> across = std::nullopt;
};

}  // namespace milepost
