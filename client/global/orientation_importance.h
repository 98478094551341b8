// The paper's importance of a particle: how well the orientations of the walls visible from it
// agree with the observed ones (the aerial paper, section IV, Eqs. 2 to 4).
#pragma once

#include <span>

#include "client/global/pose2.h"
#include "client/global/ray_casting_grid.h"
#include "client/global/view_sections.h"

namespace milepost {

// The angle between two undirected orientations, in [0, pi / 2].
double angle_between_orientations_rad(double a_rad, double b_rad);

// Eq. 2 for one observed orientation: nearly 1 up to 10 degrees, 1/2 at 20, nearly 0 from 30 on.
double similarity(double angle_rad);

// W_m of Eq. 4, in [0, 1]; 0 without sections. Walls farther than `reach_m` are not visible.
double orientation_importance(const Pose2& pose, std::span<const ViewSection> sections,
                              const RayCastingGrid& walls, double reach_m);

}  // namespace milepost
