// Boxes of latitude and longitude, to rule out far segments before any geometry.
#pragma once

#include <vector>

#include "schema/geo/geodesy.h"

namespace milepost::server {

struct DegreeBox {
  double west_deg = 0;
  double south_deg = 0;
  double east_deg = 0;
  double north_deg = 0;

  // REQUIRES: not empty.
  static DegreeBox around(const std::vector<GeoPoint>& points);
  static DegreeBox joined(const DegreeBox& a, const DegreeBox& b);

  // False only if every point of the box is farther than `radius_m` from `position`, also across
  // the antimeridian and near the poles.
  bool may_be_within(const GeoPoint& position, double radius_m) const;
};

}  // namespace milepost::server
