#include "client/global/evidence.h"

#include <algorithm>
#include <cmath>

#include "client/global/orientation_importance.h"

namespace milepost {

double evidence_per_m(const PlanPose& pose, double wheel_scale, const WallObservation& observation,
                      const WallIndex& walls, const EvidenceSettings& settings) {
  const auto beams = static_cast<double>(observation.beams.size());
  const double of_ranges = std::max(
      settings.least_per_beam * beams,
      range_agreement(pose, wheel_scale, observation.beams, walls, settings.ranges).log_likelihood);
  if (observation.sections.empty()) return settings.per_beam * of_ranges;
  const double importance =
      orientation_importance(pose, observation.sections, walls, settings.view_reach_m);
  return settings.per_beam * of_ranges +
         settings.orientations * std::log(settings.least_importance + importance);
}

void weigh_by_evidence(ParticleCloud& cloud, const WallObservation& observation, double way_m,
                       const WallIndex& walls, const EvidenceSettings& settings) {
  if (observation.beams.empty()) return;
  std::vector<double> log_likelihoods;
  for (const Particle& particle : cloud) {
    log_likelihoods.push_back(
        way_m * evidence_per_m(particle.pose, particle.wheel_scale, observation, walls, settings));
  }
  weigh_cloud(cloud, log_likelihoods);
}

}  // namespace milepost
