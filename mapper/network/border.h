// A line that divides a map in two.
#pragma once

#include <utility>

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

  // The distance of a geocentric position from the border, positive to the left of someone who goes
  // from the first point to the second.
  double left_m(const Eigen::Vector3d& position_m) const { return normal_.dot(position_m); }
  bool has_left(const Eigen::Vector3d& position_m) const { return left_m(position_m) > 0; }

 private:
  explicit Border(Eigen::Vector3d normal) : normal_(std::move(normal)) {}

  Eigen::Vector3d normal_;  // of the ellipse's plane, a unit vector
};

}  // namespace milepost
