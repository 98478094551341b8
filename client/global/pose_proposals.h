// Poses proposed by a frame, drawn from the whole area: to initialize a filter without a prior, and
// to test its belief later.
#pragma once

#include <cstddef>

#include "client/global/particle_set.h"
#include "client/global/wall_observer.h"

namespace milepost {

// A pose at a uniformly drawn position, rotated so that the wall in view has an observed
// orientation: of all headings about as many remain as there are wall orientations. Then it is
// moved towards or away from walls until two of the beams end at them: of the positions across a
// street one remains. The heading stays uniform if no wall is in view; the position stays if there
// are no beams. REQUIRES: the observation's sections are not empty.
Pose2 proposed_pose(const WallObservation& observation, const RayCastingGrid& walls,
                    const PlanBox& area, double reach_m, Random& random);

// Proposed poses with equal weights.
ParticleSet proposed_particles(std::size_t count, const WallObservation& observation,
                               const RayCastingGrid& walls, const PlanBox& area, double reach_m,
                               Random& random);

}  // namespace milepost
