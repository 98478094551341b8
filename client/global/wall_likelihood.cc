#include "client/global/wall_likelihood.h"

#include <algorithm>
#include <cmath>

#include "client/global/orientation_importance.h"

namespace milepost {

double log_likelihood_per_m(const Pose2& pose, double odometry_scale,
                            const WallObservation& observation, const RayCastingGrid& walls,
                            const WallLikelihoodSettings& settings) {
  const auto beams = static_cast<double>(observation.beams.size());
  const double of_ranges =
      std::max(settings.least_per_beam * beams,
               range_likelihood(pose, odometry_scale, observation.beams, walls, settings.ranges)
                   .log_likelihood);
  if (observation.sections.empty()) return settings.per_beam * of_ranges;
  const double importance =
      orientation_importance(pose, observation.sections, walls, settings.view_reach_m);
  return settings.per_beam * of_ranges +
         settings.orientations * std::log(settings.least_importance + importance);
}

void measurement_update(ParticleSet& particles, const WallObservation& observation,
                        double distance_m, const RayCastingGrid& walls,
                        const WallLikelihoodSettings& settings) {
  if (observation.beams.empty()) return;
  std::vector<double> log_likelihoods;
  for (const Particle& particle : particles) {
    log_likelihoods.push_back(distance_m * log_likelihood_per_m(particle.pose,
                                                                particle.odometry_scale,
                                                                observation, walls, settings));
  }
  update_weights(particles, log_likelihoods);
}

}  // namespace milepost
