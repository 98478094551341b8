// The pose of the camera according to a tracker's belief.
#pragma once

#include <array>
#include <cmath>
#include <optional>

#include "schema/geo/geodesy.h"
#include "schema/geo/route_line.h"

namespace milepost {

// The pose of the camera in six degrees of freedom.
struct GeoCameraPose {
  GeoPoint position;
  double heading_deg = 0;  // clockwise from north, [0, 360)
  double pitch_deg = 0;    // upwards
  double roll_deg = 0;     // clockwise as seen by the driver
  // Row-major covariance of east, north, up (metres), heading, pitch, roll (degrees).
  std::array<double, 36> covariance = {};

  // Of its distance in plan from the truth.
  double sigma_in_plan_m() const { return std::sqrt(covariance[0] + covariance[7]); }
};

// Known to some methods only.
struct FullPose {
  double lateral_m = 0;  // from the segment's line, positive to the right
  double lateral_sigma_m = 0;
  GeoCameraPose camera;
};

struct TrackedPose {
  double along_m = 0;
  double sigma_m = 0;
  std::optional<FullPose> full = std::nullopt;
};

// The position of the camera; on the line if its lateral offset is unknown.
inline GeoPoint position_of(const TrackedPose& at, const RouteLine& line) {
  return at.full ? at.full->camera.position : line.point_at(at.along_m);
}

}  // namespace milepost
