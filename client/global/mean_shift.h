// The densest mode of a particle set (mean shift: Comaniciu and Meer, IEEE TPAMI 24, 2002; the
// aerial paper, section IV).
#pragma once

#include "client/global/particle_set.h"

namespace milepost {

// A mode of the belief: statistics of the particles within the kernel around it.
struct BeliefMode {
  Pose2 pose;              // weighted mean
  double probability = 0;  // sum of the weights within the kernel: (0, 1]
  double sigma_m = 0;      // standard deviation of position, per axis
  double heading_sigma_rad = 0;
  double odometry_scale = 1;  // weighted mean
};

struct ModeKernel {
  double radius_m = 5;
  double heading_rad = 0.35;
};

// The mode with the highest probability, searched from the heaviest bins. REQUIRES: the set is not
// empty.
BeliefMode densest_mode(const ParticleSet& particles, const ModeKernel& kernel);

}  // namespace milepost
