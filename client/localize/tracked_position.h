// Where a belief puts the camera.
#pragma once

#include <array>
#include <optional>

#include "schema/geo/geodesy.h"
#include "schema/geo/route_line.h"

namespace milepost {

// The camera in six degrees of freedom.
struct CameraPlacement {
  GeoPoint position;
  double heading_deg = 0;  // clockwise from north, [0, 360)
  double pitch_deg = 0;    // upwards
  double roll_deg = 0;     // clockwise, as the driver sees it
  // Row by row, of: east, north, up (metres), heading, pitch, roll (degrees).
  std::array<double, 36> covariance = {};
};

// What only some methods know.
struct Across {
  double lateral_m = 0;  // from the segment's line, positive to the right
  double lateral_sigma_m = 0;
  CameraPlacement camera;
};

struct TrackedPosition {
  double along_m = 0;
  double sigma_m = 0;
  std::optional<Across> across = std::nullopt;
};

// In the world: beside the line, where the method knows how far.
inline GeoPoint position_of(const TrackedPosition& at, const RouteLine& line) {
  return at.across ? at.across->camera.position : line.point_at(at.along_m);
}

}  // namespace milepost
