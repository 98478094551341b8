// Proximity to a position: the rule that the server, its clients and map files share.
#pragma once

#include <optional>
#include <vector>

#include "schema/base/cell_grid.h"
#include "schema/geo/geodesy.h"
#include "schema/geo/route_line.h"

namespace milepost {

inline constexpr double kMaxNearRadiusM = 10'000;  // limits the work and the size of one response

// More than 0 and at most kMaxNearRadiusM.
bool is_near_radius(double radius_m);

// The bounding box of points. REQUIRES: not empty.
Bounds bounds_around(const std::vector<GeoPoint>& points);

// A box around all positions within the radius, and some beyond. May cross longitude 180.
// REQUIRES: is_near_radius.
Bounds bounds_within(const GeoPoint& position, double radius_m);

// False only if every point of the box is farther than `radius_m` from `position`, also across
// longitude 180 and near the poles. REQUIRES: the box does not cross longitude 180.
bool may_be_within(const Bounds& box, const GeoPoint& position, double radius_m);

// A line with its bounding box, which rules out distant positions without geodesic computations.
struct BoxedLine {
  explicit BoxedLine(RouteLine given)
      : line(std::move(given)), box(bounds_around(line.vertices())) {}

  RouteLine line;
  Bounds box;

  // Nothing if the line does not pass within the radius.
  std::optional<LineProjection> nearest_within(const GeoPoint& position, double radius_m) const;
};

}  // namespace milepost
