#include "client/global/plan_filter.h"

#include <cmath>

namespace milepost {
namespace {

constexpr double kStandsM = 0.01;
constexpr double kStandsRad = 0.001;
constexpr double kKnownStartWayM = 20;

}  // namespace

ParticleSet initial_particles(const FilterSettings& settings, const PlanBox& area, Random& random) {
  return settings.start ? particles_about(*settings.start, settings.particles, random)
                        : uniform_particles(settings.particles, area, random);
}

ConvergenceSettings convergence_settings(const FilterSettings& settings) {
  ConvergenceSettings convergence = settings.convergence;
  if (settings.start)
    convergence.min_found_distance_m = convergence.min_found_straight_m = kKnownStartWayM;
  return convergence;
}

bool is_moving(const OdometryIncrement& motion) {
  return std::abs(motion.distance_m) > kStandsM || std::abs(motion.turn_rad) > kStandsRad;
}

}  // namespace milepost
