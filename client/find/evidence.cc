#include "client/find/evidence.h"

#include <algorithm>
#include <cmath>

#include "client/find/orientation_importance.h"

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

}  // namespace milepost
