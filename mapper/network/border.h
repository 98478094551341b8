// A line that divides a map in two.
#pragma once

#include <Eigen/Core>

#include "schema/base/result.h"
#include "schema/geo/geodesy.h"

namespace milepost {

// The great ellipse through two points: the ellipsoid's section with a plane through its centre. It
// has no ends.
class Border {
 public:
  // Errors: invalid_input (a position that is none, points nearer than 1 m).
  static Result<Border> through(const GeoPoint& from, const GeoPoint& to);

  // Whether a geocentric position is to the left, for someone who goes from the first point to the
  // second.
  bool has_left(const Eigen::Vector3d& position_m) const { return normal_.dot(position_m) > 0; }

 private:
  explicit Border(Eigen::Vector3d normal) : normal_(std::move(normal)) {}

  Eigen::Vector3d normal_;  // of the circle's plane
};

}  // namespace milepost
