// The other places: is the vehicle where the belief says, or somewhere else? A cloud of particles
// forgets places that explain a while a little less well; here they are kept, and new ones are
// looked for all over the area (decision 22).
#pragma once

#include <cstddef>
#include <vector>

#include "client/global/evidence.h"
#include "client/global/particle_cloud.h"
#include "client/global/sight_history.h"
#include "client/global/wall_index.h"

namespace milepost {

// Not safe to use from several threads at once.
class Contest {
 public:
  // The walls must live as long as the contest. `count` challengers are drawn at a time.
  Contest(const WallIndex& walls, PlanBox area, double view_reach_m, std::size_t count);

  // The rivals go where the wheels go.
  void move(const WheelMotion& motion, Random& random);

  // Holds places against the belief, whose densest mode is at `mode`: such that the frame makes
  // likely, and the rivals of the contest before. Each is asked how well it explains the way
  // behind. They join the belief with the part of it that they earn. REQUIRES: the belief and the
  // observation's sections are not empty, the history has the observation.
  void hold(ParticleCloud& belief, const PlanPose& mode, const WallObservation& observation,
            const SightHistory& history, Random& random);

  // By how much of log-likelihood on the way behind the belief was better than the best place
  // elsewhere, when they were last held against each other; 0 before.
  double lead() const { return lead_; }

 private:
  ParticleCloud drawn(const WallObservation& observation, Random& random) const;
  std::vector<double> of_the_way(const ParticleCloud& cloud, const SightHistory& history) const;

  const WallIndex& walls_;
  PlanBox area_;
  EvidenceSettings evidence_;
  std::size_t count_;
  ParticleCloud rivals_;
  double lead_ = 0;
};

}  // namespace milepost
