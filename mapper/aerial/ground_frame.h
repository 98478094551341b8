// A local map projection in metres.
#pragma once

#include <string>

#include <Eigen/Core>
#include <GeographicLib/TransverseMercator.hpp>

#include "schema/base/cell_grid.h"
#include "schema/geo/geodesy.h"

namespace milepost {

// The transverse Mercator grid about an origin, true to scale on its meridian; 10 km to the side
// its scale is a millionth too large. Immutable, so safe to share between threads.
class GroundFrame {
 public:
  explicit GroundFrame(const GeoPoint& origin);

  const GeoPoint& origin() const { return origin_; }
  // Metres east and north of the origin; altitudes are ignored.
  Eigen::Vector2d ground_from_geo(const GeoPoint& point) const;
  GeoPoint geo_from_ground(const Eigen::Vector2d& ground_m) const;
  // The bounding box of a rectangle of the ground; if it crosses longitude 180 its west is greater
  // than its east. Around a pole it has all longitudes.
  Bounds bounds_of(const Eigen::Vector2d& south_west_m, const Eigen::Vector2d& north_east_m) const;
  // The same grid as a PROJ string.
  std::string proj() const;

 private:
  GeographicLib::TransverseMercator projection_;
  GeoPoint origin_;
  double origin_northing_m_ = 0;  // from the equator
};

}  // namespace milepost
