// Positions of one datum in another, through PROJ.
#pragma once

#include <memory>

#include "schema/base/result.h"
#include "schema/geo/datum.h"
#include "schema/geo/geodesy.h"

namespace milepost {

// Not safe to use from several threads.
class DatumTransform {
 public:
  // The epoch is that of the one that moves against the continents. Errors: invalid_input: a name
  // that PROJ does not know; no epoch where one is needed; two epochs, between which PROJ knows no
  // motion.
  static Result<DatumTransform> between(const Datum& from, const Datum& to);
  ~DatumTransform();
  DatumTransform(DatumTransform&&) noexcept;
  DatumTransform& operator=(DatumTransform&&) noexcept;

  // Errors: invalid_input: there is no way, or none that is exact to 0.2 m.
  Result<GeoPoint> transformed(const GeoPoint& position) const;

 private:
  struct Impl;
  explicit DatumTransform(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace milepost
