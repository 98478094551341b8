// The slow error of a drive's poses, and how it displaces what the drive maps.
#pragma once

#include <Eigen/Core>

#include "schema/geo/geodesy.h"
#include "schema/geo/route_line.h"

namespace milepost {

// A place of a road: the tangent frame there, and the road's direction in it (horizontal).
struct RoadPlace {
  LocalFrame local;
  Eigen::Vector3d forward = Eigen::Vector3d::UnitY();
};

RoadPlace road_place(const RouteLine& line, double along_m);

// What is recorded minus what is true. Along a straight road positions and images leave open how a
// drive is rolled: only the prior of its roll says so, and where the road is cambered, lanes
// differ.
struct PoseError {
  Eigen::Vector3d enu_m = Eigen::Vector3d::Zero();
  double roll_rad = 0;  // about the road's direction, at the road's line

  bool is_zero() const { return enu_m.isZero(0) && roll_rad == 0; }
  // By how much a landmark that is there in the place's frame is displaced.
  Eigen::Vector3d displacement_m(const RoadPlace& place, const Eigen::Vector3d& landmark_m) const {
    return enu_m + roll_rad * place.forward.cross(landmark_m);
  }
};

// The same as a vector: east, north, up, roll.
inline constexpr int kErrorAxes = 4;
inline constexpr int kRollAxis = 3;
using ErrorVector = Eigen::Matrix<double, kErrorAxes, 1>;
using ErrorMatrix = Eigen::Matrix<double, kErrorAxes, kErrorAxes>;

}  // namespace milepost
