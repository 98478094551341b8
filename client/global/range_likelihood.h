// The likelihood of triangulated points given the walls around a pose, by ray casting along their
// bearings. Ours, in addition to the paper's importance by orientations (decision 22).
#pragma once

#include <span>
#include <vector>

#include "client/global/pose2.h"
#include "client/global/ray_casting_grid.h"
#include "client/global/scene_points.h"

namespace milepost {

// A point in plan view, relative to the camera.
struct Beam {
  double bearing_rad = 0;  // clockwise from the camera's heading
  double range_m = 0;
  double range_sigma_m = 0;
};

struct BeamSettings {
  double bin_rad = 0.05;    // width of the bins of bearings
  std::size_t per_bin = 3;  // points used per bin: those with the smallest sigma
  double min_up_m = 0.5;    // above the camera; cars, hedges and fences are lower
  double max_range_m = 60;
};

// The points in plan view; `level_from_camera` rotates them to an upright camera.
std::vector<Beam> beams_of(std::span<const ScenePoint> points,
                           const Eigen::Matrix3d& level_from_camera, const BeamSettings& settings);

struct RangeSettings {
  double sigma_m = 0.5;  // of the walls' positions, in addition to their own sigma
  double heading_sigma_rad = 0.02;
  double reach_m = 80;
  double chance_nearer = 0.15;   // outlier probability of points in front of a wall: trees, cars
  double chance_farther = 0.05;  // ... and of points behind it, seen over it
};

struct RangeLikelihood {
  double log_likelihood = 0;
  double inlier_ratio = 0;  // share of the beams that end at a wall within three sigma
};

// Ranges are in units of odometry and are multiplied by `odometry_scale`.
RangeLikelihood range_likelihood(const Pose2& pose, double odometry_scale,
                                 std::span<const Beam> beams, const RayCastingGrid& walls,
                                 const RangeSettings& settings);

}  // namespace milepost
