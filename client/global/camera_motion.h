// How a camera moved between two frames, as the pose of its frame now in its frame before: what the
// wheels say, mended by what the frames have in common.
#pragma once

#include <span>

#include <Eigen/Geometry>

#include "client/global/plan_pose.h"

namespace milepost {

// before_from_now of a level camera that looks where the vehicle goes.
Eigen::Isometry3d camera_motion(const WheelMotion& wheels);

// The rays of one point, with z = 1, in both frames.
struct RayPair {
  Eigen::Vector3d before;
  Eigen::Vector3d now;
};

// How far, in units of the rays, the pair is from what the motion allows (Sampson's distance).
double epipolar_distance(const RayPair& pair, const Eigen::Isometry3d& before_from_now);

// The motion that fits the pairs best, robustly, near the one the wheels tell: turned about all
// three axes, and in the direction of its way; its length stays. `ray_sigma` is the noise of a ray.
Eigen::Isometry3d refined_motion(std::span<const RayPair> pairs, const Eigen::Isometry3d& start,
                                 double ray_sigma);

}  // namespace milepost
