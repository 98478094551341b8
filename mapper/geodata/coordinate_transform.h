// Coordinates of other reference systems, through PROJ.
#pragma once

#include <memory>
#include <string>

#include "schema/base/result.h"
#include "schema/geo/geodesy.h"

namespace milepost {

// From a reference system to degrees and heights above the ellipsoid: of the same datum, or of
// WGS 84 where that has another ellipsoid. Not safe to use from several threads.
class CoordinateTransform {
 public:
  // `crs` is what PROJ understands: "EPSG:25832", "EPSG:4978" (geocentric), "EPSG:25832+7837" (with
  // heights above a geoid, if its grid is installed). Errors: invalid_input.
  static Result<CoordinateTransform> from(const std::string& crs);
  ~CoordinateTransform();
  CoordinateTransform(CoordinateTransform&&) noexcept;
  CoordinateTransform& operator=(CoordinateTransform&&) noexcept;

  // The name of the datum, as Datum has it: "ETRS89".
  const std::string& datum() const;

  bool is_geocentric() const;  // X, Y and Z

  // Easting, northing and height; longitude, latitude and height; or X, Y and Z. Errors:
  // invalid_input.
  Result<GeoPoint> geographic_of(double x, double y, double z) const;

 private:
  struct Impl;
  explicit CoordinateTransform(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace milepost
