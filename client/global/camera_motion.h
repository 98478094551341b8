// How a camera moved between two frames: what the wheels say, mended by what the frames have in
// common.
#pragma once

#include <span>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "client/global/plan_pose.h"

namespace milepost {

// A point with the coordinates p in the camera frame before has now_from_before * (p - way_m) now.
struct CameraMotion {
  Eigen::Matrix3d now_from_before = Eigen::Matrix3d::Identity();
  Eigen::Vector3d way_m = Eigen::Vector3d::Zero();  // in the camera frame before
};

// Of a level camera that looks where the vehicle goes.
CameraMotion camera_motion(const WheelMotion& wheels);

// The rays of one point, with z = 1, in both frames.
struct RayPair {
  Eigen::Vector3d before;
  Eigen::Vector3d now;
};

// How far, in units of the rays, the pair is from what the motion allows (Sampson's distance).
double epipolar_distance(const RayPair& pair, const CameraMotion& motion);

// The motion that fits the pairs best, robustly, near the one the wheels tell: turned about all
// three axes, and in the direction of its way; its length stays. `ray_sigma` is the noise of a ray.
CameraMotion refined_motion(std::span<const RayPair> pairs, const CameraMotion& start,
                            double ray_sigma);

}  // namespace milepost
