// Tests the belief against alternative hypotheses. A particle set forgets poses that explain the
// measurements slightly less well for a while; here they are kept, and new ones are proposed all
// over the area (decision 22).
#pragma once

#include <cstddef>
#include <vector>

#include "client/global/measurement_window.h"
#include "client/global/particle_set.h"
#include "client/global/ray_casting_grid.h"
#include "client/global/wall_likelihood.h"

namespace milepost {

// Not safe to use from several threads at once.
class AlternativeHypotheses {
 public:
  // REQUIRES: the walls outlive this object. `count` proposals are drawn per test.
  AlternativeHypotheses(const RayCastingGrid& walls, PlanBox area, double view_reach_m,
                        std::size_t count);

  // Propagates the alternatives by odometry.
  void move(const OdometryIncrement& motion, Random& random);

  // Tests proposals against the belief, whose densest mode is at `mode`: poses that the frame makes
  // likely, and the alternatives of the previous test. The likelihoods are those of the whole
  // measurement window. The proposals join the belief with the part of the probability that their
  // likelihood ratio gives them. REQUIRES: the belief and the observation's sections are not empty;
  // the window contains the observation.
  void test(ParticleSet& belief, const Pose2& mode, const WallObservation& observation,
            const MeasurementWindow& window, Random& random);

  // The log-likelihood ratio over the window of the best particle of the belief to the best
  // alternative elsewhere, at the last test; 0 before.
  double log_likelihood_ratio() const { return log_likelihood_ratio_; }

 private:
  ParticleSet drawn(const WallObservation& observation, Random& random) const;
  std::vector<double> log_likelihoods(const ParticleSet& particles,
                                      const MeasurementWindow& window) const;

  const RayCastingGrid& walls_;
  PlanBox area_;
  WallLikelihoodSettings likelihood_;
  std::size_t count_;
  ParticleSet alternatives_;
  double log_likelihood_ratio_ = 0;
};

}  // namespace milepost
