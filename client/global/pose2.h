// SE(2) poses and their propagation by odometry.
#pragma once

#include <cmath>

#include <Eigen/Core>

namespace milepost {

// The horizontal pose of a vehicle's camera in a local tangent frame.
struct Pose2 {
  Eigen::Vector2d enu_m = Eigen::Vector2d::Zero();  // east, north
  double heading_rad = 0;                           // clockwise from north
};

// The unit vector (east, north) of an azimuth, clockwise from north.
inline Eigen::Vector2d direction_of(double azimuth_rad) {
  return {std::sin(azimuth_rad), std::cos(azimuth_rad)};
}

// The motion between two times by wheel odometry.
struct OdometryIncrement {
  double duration_s = 0;
  double distance_m = 0;  // forwards
  double turn_rad = 0;    // clockwise
};

// The aerial paper, Eq. 1: a step along the chord, whose direction is that after half of the turn.
inline Pose2 moved(const Pose2& pose, double distance_m, double turn_rad) {
  return {pose.enu_m + distance_m * direction_of(pose.heading_rad + turn_rad / 2),
          pose.heading_rad + turn_rad};
}

}  // namespace milepost
