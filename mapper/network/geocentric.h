// Positions on the ellipsoid without a local frame.
#pragma once

#include <Eigen/Core>

#include "schema/geo/geodesy.h"

namespace milepost {

// The geocentric Cartesian position, in metres, of a point without its altitude.
Eigen::Vector3d geocentric(const GeoPoint& point);

}  // namespace milepost
