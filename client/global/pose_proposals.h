// Poses that a frame makes likely, drawn from the whole area: where a filter starts without any
// idea, and what challenges the belief later.
#pragma once

#include <cstddef>

#include "client/global/particle_cloud.h"
#include "client/global/wall_observer.h"

namespace milepost {

// A place anywhere in the area, turned so that the wall that it looks at has an orientation that is
// seen there: of all headings only about as many are left as walls have orientations. Then it is
// moved towards or away from walls until two of the beams end at them: of the places across a
// street one is left. Any heading where it looks at no wall; not moved where there are no beams.
// REQUIRES: the observation's sections are not empty.
PlanPose proposed_pose(const WallObservation& observation, const WallIndex& walls,
                       const PlanBox& area, double reach_m, Random& random);

// Of equal weight.
ParticleCloud proposed_cloud(std::size_t count, const WallObservation& observation,
                             const WallIndex& walls, const PlanBox& area, double reach_m,
                             Random& random);

}  // namespace milepost
