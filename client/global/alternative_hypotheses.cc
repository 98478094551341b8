#include "client/global/alternative_hypotheses.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "client/global/odometry_noise.h"
#include "client/global/pose_proposals.h"

namespace milepost {
namespace {

constexpr std::size_t kCandidates = 5;  // per proposal
constexpr double kScatterM = 1.5;       // jitter of the proposals
constexpr double kScatterRad = 2 * kRadPerDeg;
constexpr std::size_t kBeliefSample = 100;  // particles that represent the belief in a test
constexpr double kBeliefAdvantage = 1;      // of log-likelihood
constexpr double kHistoryPart = 0.5;        // weight of the window, since odometry drifts
constexpr double kMaxPart = 0.5;            // of the belief, gained by proposals in a test

constexpr double kElsewhereM = 5;
constexpr double kElsewhereRad = 0.35;
constexpr double kAlternativeScatterM = 0.5;
constexpr double kAlternativeScatterRad = 1 * kRadPerDeg;

// Resamples the particles that lie or head elsewhere; empty if none do.
ParticleSet resampled_elsewhere(const ParticleSet& particles, const Pose2& place, std::size_t count,
                                Random& random) {
  ParticleSet others = particles;
  std::erase_if(others, [&](const Particle& particle) {
    const double off_m = (particle.pose.enu_m - place.enu_m).norm();
    const double turn_rad =
        std::remainder(particle.pose.heading_rad - place.heading_rad, 2 * std::numbers::pi);
    return off_m <= kElsewhereM && std::abs(turn_rad) <= kElsewhereRad;
  });
  if (others.empty()) return {};
  normalize(others);
  return resampled(others, count, random);
}

}  // namespace

AlternativeHypotheses::AlternativeHypotheses(const RayCastingGrid& walls, PlanBox area,
                                             double view_reach_m, std::size_t count)
    : walls_(walls), area_(std::move(area)), count_(count) {
  likelihood_.ranges = kBroadRanges;
  likelihood_.view_reach_m = view_reach_m;
}

void AlternativeHypotheses::move(const OdometryIncrement& motion, Random& random) {
  if (alternatives_.empty()) return;
  propagate(alternatives_, motion, kOdometryNoise, walls_, area_, Crossing::dropped, random);
}

void AlternativeHypotheses::test(ParticleSet& belief, const Pose2& mode,
                                 const WallObservation& observation,
                                 const MeasurementWindow& window, Random& random) {
  ParticleSet proposals = drawn(observation, random);
  proposals.insert(proposals.end(), alternatives_.begin(), alternatives_.end());
  for (Particle& proposal : proposals) proposal.weight = 1;
  update_weights(proposals, log_likelihoods(proposals, window));
  alternatives_ = resampled_elsewhere(proposals, mode, count_, random);
  jitter(alternatives_, kAlternativeScatterM, kAlternativeScatterRad, random);
  proposals = resampled(proposals, count_, random);
  jitter(proposals, kScatterM, kScatterRad, random);
  ParticleSet belief_sample = resampled(belief, kBeliefSample, random);

  const std::vector<double> log_likelihoods_of_belief = log_likelihoods(belief_sample, window);
  if (!alternatives_.empty()) {
    const std::vector<double> log_likelihoods_of_alternatives =
        log_likelihoods(alternatives_, window);
    log_likelihood_ratio_ = std::ranges::max(log_likelihoods_of_belief) -
                            std::ranges::max(log_likelihoods_of_alternatives);
  }
  const double proposals_ratio = update_weights(proposals, log_likelihoods(proposals, window)) -
                                 update_weights(belief_sample, log_likelihoods_of_belief) -
                                 kBeliefAdvantage;
  const double part = std::min(1 / (1 + std::exp(-proposals_ratio)), kMaxPart);
  for (Particle& particle : belief) particle.weight *= 1 - part;
  for (Particle& proposal : proposals) {
    proposal.weight *= part;
    belief.push_back(proposal);
  }
}

ParticleSet AlternativeHypotheses::drawn(const WallObservation& observation, Random& random) const {
  ParticleSet candidates = proposed_particles(kCandidates * count_, observation, walls_, area_,
                                              likelihood_.view_reach_m, random);
  draw_odometry_scales(candidates, kOdometryScaleSigma, random);
  measurement_update(candidates, observation, kProposalDistanceM, walls_, likelihood_);
  return resampled(candidates, count_, random);
}

// The log-likelihood of each particle over the measurement window.
std::vector<double> AlternativeHypotheses::log_likelihoods(const ParticleSet& particles,
                                                           const MeasurementWindow& window) const {
  WallLikelihoodSettings likelihood = likelihood_;
  likelihood.per_beam *= static_cast<double>(window.beam_stride());
  std::vector<double> log_likelihoods(particles.size(), 0);
  for (const PastMeasurement& past : window.measurements()) {
    const double distance_m = kHistoryPart * std::min(past.distance_m, kMaxLikelihoodDistanceM);
    for (std::size_t i = 0; i < particles.size(); ++i) {
      const double scale = particles[i].odometry_scale;
      const Pose2 pose = window.pose_at(particles[i].pose, scale, past);
      log_likelihoods[i] +=
          distance_m * log_likelihood_per_m(pose, scale, past.observation, walls_, likelihood);
    }
  }
  return log_likelihoods;
}

}  // namespace milepost
