#include "client/evaluate/baselines/orientation_filter.h"

#include <cmath>
#include <vector>

#include "client/global/orientation_importance.h"
#include "schema/geo/geodesy.h"

namespace milepost {
namespace {

// Section IV.
constexpr MotionNoise kMotionNoise{0.1, 0, 5 * kRadPerDeg};

// Keeps the sum of the weights above 0.
constexpr double kLeastImportance = 1e-9;

class OrientationFilter : public PlanFilter {
 public:
  OrientationFilter(const RayCastingGrid& walls, const PlanBox& area,
                    const FilterSettings& settings)
      : walls_(walls),
        area_(area),
        settings_(settings),
        random_(settings.seed),
        particles_(initial_particles(settings, area, random_)),
        monitor_(convergence_settings(settings)) {}

  PlanEstimate update(const WallObservation& observation,
                      const OdometryIncrement& motion) override {
    if (is_moving(motion)) {
      propagate(particles_, motion, kMotionNoise, walls_, area_, Crossing::drawn_anew, random_);
    }
    weigh_by_importance(observation);
    const BeliefMode mode = densest_mode(particles_, {});
    const GlobalStatus status =
        monitor_.observe(mode, inlier_ratio_of(mode.pose, observation), false, motion);
    particles_ = resampled(particles_, settings_.particles, random_);
    return {status, mode, monitor_.inlier_ratio()};
  }

  const ParticleSet& particles() const override { return particles_; }

 private:
  double importance(const Pose2& pose, const WallObservation& observation) const {
    return orientation_importance(pose, observation.sections, walls_, settings_.view_reach_m);
  }

  // Eq. 4. Every frame has the same weight.
  void weigh_by_importance(const WallObservation& observation) {
    if (observation.sections.empty()) return;
    std::vector<double> log_likelihoods;
    log_likelihoods.reserve(particles_.size());
    for (const Particle& particle : particles_) {
      log_likelihoods.push_back(
          std::log(kLeastImportance + importance(particle.pose, observation)));
    }
    update_weights(particles_, log_likelihoods);
  }

  std::optional<double> inlier_ratio_of(const Pose2& pose,
                                        const WallObservation& observation) const {
    if (observation.sections.empty()) return std::nullopt;
    return importance(pose, observation);
  }

  const RayCastingGrid& walls_;
  PlanBox area_;
  FilterSettings settings_;
  Random random_;
  ParticleSet particles_;
  ConvergenceMonitor monitor_;
};

}  // namespace

GlobalMethod orientations_method() {
  return {.with_beams = false, .make_filter = make_plan_filter<OrientationFilter>};
}

}  // namespace milepost
