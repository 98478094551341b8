#include "client/global/wall_particle_filter.h"

#include <algorithm>
#include <cmath>

#include "client/global/odometry_noise.h"
#include "client/global/pose_proposals.h"
#include "client/global/wall_likelihood.h"
#include "schema/geo/geodesy.h"

namespace milepost {
namespace {

constexpr std::size_t kStartCandidates = 10;  // per particle
constexpr std::size_t kParticlesPerProposal = 10;
constexpr double kFoundLogLikelihoodRatio = 4;  // of the belief over any alternative, to converge

constexpr double kBinM = 1;
constexpr double kBinRad = 5 * kRadPerDeg;

}  // namespace

WallParticleFilter::WallParticleFilter(const RayCastingGrid& walls, const PlanBox& area,
                                       const FilterSettings& settings)
    : walls_(walls),
      area_(area),
      settings_(settings),
      random_(settings.seed),
      particles_(initial_particles(settings, area, random_)),
      monitor_(convergence_settings(settings)),
      window_(MeasurementWindowSettings()),
      alternatives_(walls, area, settings.view_reach_m,
                    std::max<std::size_t>(1, settings.particles / kParticlesPerProposal)),
      is_started_(settings.start.has_value()) {
  draw_odometry_scales(particles_, kOdometryScaleSigma, random_);
}

PlanEstimate WallParticleFilter::update(const WallObservation& observation,
                                        const OdometryIncrement& motion) {
  distance_m_ += std::abs(motion.distance_m);
  if (is_moving(motion)) {
    const bool is_about_start = settings_.start && !monitor_.was_found();
    propagate(particles_, motion, kOdometryNoise, walls_, area_,
              is_about_start ? Crossing::dropped : Crossing::drawn_anew, random_);
    alternatives_.move(motion, random_);
  }
  const bool is_kept = window_.add(observation, motion);
  if (!is_started_ && !observation.beams.empty() && !observation.sections.empty()) {
    start_from(observation);
  } else {
    weigh_by_distance(observation, std::min(distance_m_, kMaxLikelihoodDistanceM));
  }
  if (!observation.beams.empty()) distance_m_ = 0;

  const BeliefMode mode = densest_mode(particles_, {});
  const GlobalStatus status =
      monitor_.observe(mode, inlier_ratio_of(mode, observation), has_alternative(), motion);
  if (is_kept && !observation.sections.empty() && is_tested()) {
    alternatives_.test(particles_, mode.pose, observation, window_, random_);
  }
  resample();
  return {status, mode, monitor_.inlier_ratio()};
}

// A frame counts by the distance travelled.
void WallParticleFilter::weigh_by_distance(const WallObservation& observation, double distance_m) {
  WallLikelihoodSettings likelihood;
  likelihood.ranges = monitor_.is_found() ? kSharpRanges : kBroadRanges;
  likelihood.view_reach_m = settings_.view_reach_m;
  measurement_update(particles_, observation, distance_m, walls_, likelihood);
}

void WallParticleFilter::start_from(const WallObservation& observation) {
  particles_ = proposed_particles(kStartCandidates * settings_.particles, observation, walls_,
                                  area_, settings_.view_reach_m, random_);
  draw_odometry_scales(particles_, kOdometryScaleSigma, random_);
  weigh_by_distance(observation, kProposalDistanceM);
  is_started_ = true;
}

std::optional<double> WallParticleFilter::inlier_ratio_of(
    const BeliefMode& mode, const WallObservation& observation) const {
  if (observation.beams.empty()) return std::nullopt;
  return range_likelihood(mode.pose, mode.odometry_scale, observation.beams, walls_, kSharpRanges)
      .inlier_ratio;
}

// Whether an alternative hypothesis explains the measurement window nearly as well. Only while
// alternatives are tested.
bool WallParticleFilter::has_alternative() const {
  return is_tested() && alternatives_.log_likelihood_ratio() < kFoundLogLikelihoodRatio;
}

// A converged mode is tested only when its inlier ratio drops; a known start is not tested.
bool WallParticleFilter::is_tested() const {
  if (monitor_.is_found()) return monitor_.is_doubtful();
  return !settings_.start || monitor_.was_found();
}

void WallParticleFilter::resample() {
  const std::size_t enough =
      monitor_.is_found()
          ? std::min(settings_.particles, enough_particles(particles_, kBinM, kBinRad))
          : settings_.particles;
  const auto count = static_cast<double>(particles_.size());
  const bool is_uneven = effective_count(particles_) < count / 2;
  const bool are_few = particles_.size() < enough / 2;
  if (is_uneven || are_few || particles_.size() > enough)
    particles_ = resampled(particles_, enough, random_);
}

GlobalMethod combined_method() {
  return {.with_beams = true, .make_filter = make_plan_filter<WallParticleFilter>};
}

}  // namespace milepost
