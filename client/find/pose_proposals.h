// Poses that a frame makes likely, drawn from the whole area: where a filter starts without any
// idea, and what challenges the belief later.
#pragma once

#include <cstddef>
#include <span>

#include "client/find/particle_cloud.h"
#include "client/find/wall_sightings.h"

namespace milepost {

// A place anywhere in the area, turned so that the wall that it looks at has an orientation that is
// seen there: of all headings only about as many are left as walls have orientations. Any heading
// where it looks at no wall. REQUIRES: sections are not empty.
PlanPose oriented_pose(std::span<const ViewSection> sections, const WallIndex& walls,
                       const PlanBox& area, double reach_m, Random& random);

// Of equal weight.
ParticleCloud oriented_cloud(std::size_t count, std::span<const ViewSection> sections,
                             const WallIndex& walls, const PlanBox& area, double reach_m,
                             Random& random);

}  // namespace milepost
