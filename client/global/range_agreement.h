// How well the points that a camera saw agree with the walls about a pose: each is looked for along
// its bearing. Ours beside the paper's importance by orientations (decision 22).
#pragma once

#include <span>
#include <vector>

#include "client/global/plan_pose.h"
#include "client/global/scene_points.h"
#include "client/global/wall_index.h"

namespace milepost {

// A point in plan view, from the camera.
struct Beam {
  double bearing_rad = 0;  // clockwise from the camera's heading
  double range_m = 0;
  double range_sigma_m = 0;
};

struct BeamSettings {
  double bin_rad = 0.05;    // the view is divided into bins of this width
  std::size_t per_bin = 3;  // points of each that count: the best known
  double min_up_m = 0.5;    // over the camera; lower are cars, hedges and fences
  double max_range_m = 60;
};

// Plan view of the points; `level_from_camera` takes them to an upright camera.
std::vector<Beam> beams_of(std::span<const ScenePoint> points,
                           const Eigen::Matrix3d& level_from_camera, const BeamSettings& settings);

struct RangeSettings {
  double sigma_m = 0.5;  // of the walls' places, beyond their own sigma
  double heading_sigma_rad = 0.02;
  double reach_m = 80;
  double chance_nearer = 0.15;   // weight of what stands before a wall: trees, cars
  double chance_farther = 0.05;  // ... of what is seen over a wall
};

struct RangeAgreement {
  double log_likelihood = 0;
  double explained = 0;  // share of the beams that end at a wall, within three sigma
};

// Ranges are the wheels' until they are multiplied by their scale.
RangeAgreement range_agreement(const PlanPose& pose, double wheel_scale,
                               std::span<const Beam> beams, const WallIndex& walls,
                               const RangeSettings& settings);

}  // namespace milepost
