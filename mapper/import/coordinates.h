// Coordinates of other reference systems, through PROJ.
#pragma once

#include <memory>
#include <string>

#include "schema/base/result.h"
#include "schema/geo/geodesy.h"

namespace milepost {

// From a reference system to WGS84 with ellipsoidal heights. Not safe to use from several threads.
class CoordinateTransform {
 public:
  // `crs` is what PROJ understands: "EPSG:25832", "EPSG:4978" (geocentric), "EPSG:25832+7837" (with
  // heights above a geoid, if its grid is installed). Errors: invalid_input.
  static Result<CoordinateTransform> from(const std::string& crs);
  ~CoordinateTransform();
  CoordinateTransform(CoordinateTransform&&) noexcept;
  CoordinateTransform& operator=(CoordinateTransform&&) noexcept;

  // Easting, northing and height; longitude, latitude and height; or X, Y and Z. Errors:
  // invalid_input.
  Result<GeoPoint> wgs84_of(double x, double y, double z) const;

 private:
  struct Impl;
  explicit CoordinateTransform(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace milepost
