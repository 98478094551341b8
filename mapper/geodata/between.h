// Positions between others.
#pragma once

#include "schema/geo/geodesy.h"

namespace milepost {

// On the straight line from one position to another, so far of the way.
inline GeoPoint position_between(const GeoPoint& from, const GeoPoint& to, double part) {
  const LocalFrame local(from);
  const EnuPoint way = local.enu_from_geo(to);
  return local.geo_from_enu({part * way.east_m, part * way.north_m, part * way.up_m});
}

}  // namespace milepost
