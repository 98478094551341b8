// Where the belief of a cloud of particles is densest (mean shift: Comaniciu and Meer, IEEE TPAMI
// 24, 2002; the aerial paper, section IV).
#pragma once

#include "client/global/particle_cloud.h"

namespace milepost {

// A mode of the belief, by the particles within the kernel about it.
struct BeliefMode {
  PlanPose pose;       // their weighted mean
  double mass = 0;     // of all weights, those within the kernel: (0, 1]
  double sigma_m = 0;  // of position, in each direction
  double heading_sigma_rad = 0;
  double wheel_scale = 1;  // their weighted mean
};

struct ModeKernel {
  double radius_m = 5;
  double heading_rad = 0.35;
};

// The mode with the most mass, sought from the densest parts of the cloud.
// REQUIRES: the cloud is not empty.
BeliefMode densest_mode(const ParticleCloud& cloud, const ModeKernel& kernel);

}  // namespace milepost
