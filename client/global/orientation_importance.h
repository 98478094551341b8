// The paper's importance of a particle: how well the orientations of the walls that it ought to see
// agree with those that are seen (the aerial paper, section IV, Eqs. 2 to 4).
#pragma once

#include <span>

#include "client/global/plan_pose.h"
#include "client/global/wall_index.h"
#include "client/global/wall_sightings.h"

namespace milepost {

// Between two orientations, which have no sense: 0 to pi / 2.
double angle_between_orientations_rad(double a_rad, double b_rad);

// Eq. 2 of one observed orientation: nearly 1 up to 10 degrees, 1/2 at 20, nearly 0 from 30 on.
double similarity(double angle_rad);

// W_m of Eq. 4, in [0, 1]; 0 without sections. Walls farther than `reach_m` are not seen.
double orientation_importance(const PlanPose& pose, std::span<const ViewSection> sections,
                              const WallIndex& walls, double reach_m);

}  // namespace milepost
