// The motion of a camera between two frames, as the pose of the current frame in the previous one:
// predicted by odometry and refined by matched points.
#pragma once

#include <span>

#include <Eigen/Geometry>

#include "client/global/pose2.h"

namespace milepost {

// before_from_now of a level camera that looks in the driving direction.
Eigen::Isometry3d camera_motion(const OdometryIncrement& odometry);

// The rays of one point in both frames, with z = 1.
struct RayPair {
  Eigen::Vector3d before;
  Eigen::Vector3d now;
};

// Signed Sampson distance of the pair from the epipolar constraint of the motion, in units of the
// rays.
double epipolar_distance(const RayPair& pair, const Eigen::Isometry3d& before_from_now);

// The motion that fits the pairs best near `start`, by robust least squares with a prior from
// odometry. It corrects all three rotations and the direction of the translation; the length of the
// translation stays. `ray_sigma` is the noise of a ray.
Eigen::Isometry3d refined_motion(std::span<const RayPair> pairs, const Eigen::Isometry3d& start,
                                 double ray_sigma);

}  // namespace milepost
