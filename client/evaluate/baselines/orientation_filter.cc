#include "client/evaluate/baselines/orientation_filter.h"

#include <cmath>
#include <vector>

#include "client/global/orientation_importance.h"
#include "schema/geo/geodesy.h"

namespace milepost {
namespace {

// Section IV.
constexpr MotionNoise kMotionNoise{0.1, 0, 5 * kRadPerDeg};

// A particle that explains nothing keeps a trace, so that the weights have a sum.
constexpr double kLeastImportance = 1e-9;

class OrientationFilter : public PlanFilter {
 public:
  OrientationFilter(const WallIndex& walls, const PlanBox& area, const FilterSettings& settings)
      : walls_(walls),
        area_(area),
        settings_(settings),
        random_(settings.seed),
        cloud_(first_cloud(settings, area, random_)),
        watch_(watch_settings(settings)) {}

  Found update(const WallObservation& observation, const WheelMotion& motion) override {
    if (is_moving(motion)) {
      move_cloud(cloud_, motion, kMotionNoise, walls_, area_, Crossing::drawn_anew, random_);
    }
    weigh_by_importance(observation);
    const BeliefMode mode = densest_mode(cloud_, {});
    const FindStatus status =
        watch_.observe(mode, explained_by(mode.pose, observation), false, motion);
    cloud_ = resampled(cloud_, settings_.particles, random_);
    return {status, mode, watch_.explained()};
  }

  const ParticleCloud& particles() const override { return cloud_; }

 private:
  double importance(const PlanPose& pose, const WallObservation& observation) const {
    return orientation_importance(pose, observation.sections, walls_, settings_.view_reach_m);
  }

  // Eq. 4. Every frame weighs alike.
  void weigh_by_importance(const WallObservation& observation) {
    if (observation.sections.empty()) return;
    std::vector<double> log_likelihoods;
    log_likelihoods.reserve(cloud_.size());
    for (const Particle& particle : cloud_) {
      log_likelihoods.push_back(
          std::log(kLeastImportance + importance(particle.pose, observation)));
    }
    weigh_cloud(cloud_, log_likelihoods);
  }

  std::optional<double> explained_by(const PlanPose& pose,
                                     const WallObservation& observation) const {
    if (observation.sections.empty()) return std::nullopt;
    return importance(pose, observation);
  }

  const WallIndex& walls_;
  PlanBox area_;
  FilterSettings settings_;
  Random random_;
  ParticleCloud cloud_;
  ModeWatch watch_;
};

}  // namespace

FindMethod orientations_method() {
  return {.with_beams = false, .make_filter = make_plan_filter<OrientationFilter>};
}

}  // namespace milepost
