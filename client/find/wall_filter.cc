#include "client/find/wall_filter.h"

#include <algorithm>
#include <cmath>

#include "client/find/evidence.h"
#include "client/find/orientation_importance.h"
#include "client/find/pose_proposals.h"
#include "schema/geo/geodesy.h"

namespace milepost {
namespace {

// The paper, section IV, for its method; the second is for wheels as they are.
constexpr MotionNoise kPaperNoise{0.1, 0, 5 * kRadPerDeg};
constexpr MotionNoise kWheelNoise{0.1, 0.03, 1 * kRadPerDeg, 0.0005};
constexpr double kWheelScaleSigma = 0.02;  // before anything is seen

// Standing still, particles stay: noise would only spread them.
constexpr double kStandsM = 0.01;
constexpr double kStandsRad = 0.001;

// However far it went since the last frame that showed something, this is no more news.
constexpr double kMaxEvidenceWayM = 5;

// Broad while few particles have to cover an area, sharp about a place that is found.
constexpr RangeSettings kBroad{1.5, 0.05};
constexpr RangeSettings kSharp{0.5, 0.02};

constexpr std::size_t kStartCandidates = 10;  // for each particle
constexpr std::size_t kParticlesPerChallenger = 10;
constexpr std::size_t kChallengerCandidates = 5;  // for each challenger
constexpr double kCandidateWayM = 4;              // how much a frame says of them
constexpr double kChallengerSigmaM = 1.5;         // how far they lie from the best place about
constexpr double kChallengerSigmaRad = 2 * kRadPerDeg;
constexpr std::size_t kDefenders = 100;    // particles of the belief that they are held against
constexpr double kDefendersAdvantage = 1;  // of log-likelihood
constexpr double kHistoryPart = 0.5;       // of the evidence of the way behind: wheels err
constexpr double kMaxChallengedPart = 0.5;

constexpr double kBinM = 1;
constexpr double kBinRad = 5 * kRadPerDeg;

// Where the start is known, no other street is meant, and less way is enough.
constexpr double kKnownStartWayM = 20;

WatchSettings watch_settings(const FilterSettings& settings) {
  WatchSettings watch = settings.watch;
  if (settings.start) watch.found_way_m = watch.found_straight_m = kKnownStartWayM;
  return watch;
}

}  // namespace

WallFilter::WallFilter(const WallIndex& walls, const PlanBox& area, const FilterSettings& settings)
    : walls_(walls),
      area_(area),
      settings_(settings),
      random_(settings.seed),
      cloud_(settings.start ? cloud_about(*settings.start, settings.particles, random_)
                            : uniform_cloud(settings.particles, area, random_)),
      watch_(watch_settings(settings)),
      history_(settings.history),
      is_started_(settings.start.has_value()) {
  if (settings_.method == FindMethod::combined) {
    draw_wheel_scales(cloud_, kWheelScaleSigma, random_);
  }
}

Found WallFilter::update(const WallObservation& observation, const WheelMotion& motion) {
  const bool is_ours = settings_.method == FindMethod::combined;
  way_m_ += std::abs(motion.distance_m);
  if (std::abs(motion.distance_m) > kStandsM || std::abs(motion.turn_rad) > kStandsRad) {
    const bool is_about_start = is_ours && settings_.start && !watch_.was_found();
    move_cloud(cloud_, motion, is_ours ? kWheelNoise : kPaperNoise, walls_, area_,
               is_about_start ? Crossing::dropped : Crossing::drawn_anew, random_);
  }
  const bool is_sight = history_.add(observation, motion);
  if (!is_ours) {
    weigh_by_importance(observation);
  } else if (!is_started_ && !observation.beams.empty() && !observation.sections.empty()) {
    start_from(observation);
  } else {
    weigh_by_evidence(cloud_, observation, std::min(way_m_, kMaxEvidenceWayM));
  }
  if (!observation.beams.empty()) way_m_ = 0;

  const BeliefMode mode = densest_mode(cloud_, {});
  const FindStatus status = watch_.observe(mode, explained_by(mode, observation), motion);
  if (is_ours && is_sight && !observation.sections.empty() && is_challenged()) {
    challenge(observation);
  }
  resample();
  return {status, mode, watch_.explained()};
}

// The paper's method, which weighs every frame alike.
void WallFilter::weigh_by_importance(const WallObservation& observation) {
  if (observation.sections.empty()) return;
  std::vector<double> log_likelihoods;
  for (const Particle& particle : cloud_) {
    // Eq. 4; a particle that explains nothing keeps a trace, so that the weights have a sum.
    log_likelihoods.push_back(
        std::log(1e-9 + orientation_importance(particle.pose, observation.sections, walls_,
                                               settings_.view_reach_m)));
  }
  weigh_cloud(cloud_, log_likelihoods);
}

// Ours, which weighs a frame by the way driven.
void WallFilter::weigh_by_evidence(ParticleCloud& cloud, const WallObservation& observation,
                                   double way_m) const {
  if (observation.beams.empty()) return;
  EvidenceSettings evidence;
  evidence.ranges = watch_.is_found() ? kSharp : kBroad;
  evidence.view_reach_m = settings_.view_reach_m;
  std::vector<double> log_likelihoods;
  for (const Particle& particle : cloud) {
    log_likelihoods.push_back(
        way_m * evidence_per_m(particle.pose, particle.wheel_scale, observation, walls_, evidence));
  }
  weigh_cloud(cloud, log_likelihoods);
}

// The log of the cloud's likelihood over the way behind.
double WallFilter::weigh_by_history(ParticleCloud& cloud) const {
  EvidenceSettings evidence;
  evidence.ranges = kBroad;
  evidence.per_beam *= static_cast<double>(history_.each_beam());
  evidence.view_reach_m = settings_.view_reach_m;
  std::vector<double> log_likelihoods(cloud.size(), 0);
  for (const PastSight& sight : history_.sights()) {
    const double way_m = kHistoryPart * std::min(sight.way_m, kMaxEvidenceWayM);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const PlanPose pose = history_.pose_then(cloud[i].pose, cloud[i].wheel_scale, sight);
      log_likelihoods[i] +=
          way_m * evidence_per_m(pose, cloud[i].wheel_scale, sight.observation, walls_, evidence);
    }
  }
  return weigh_cloud(cloud, log_likelihoods);
}

void WallFilter::start_from(const WallObservation& observation) {
  cloud_ = proposed_cloud(kStartCandidates * settings_.particles, observation, walls_, area_,
                          settings_.view_reach_m, random_);
  draw_wheel_scales(cloud_, kWheelScaleSigma, random_);
  weigh_by_evidence(cloud_, observation, kCandidateWayM);
  is_started_ = true;
}

std::optional<double> WallFilter::explained_by(const BeliefMode& mode,
                                               const WallObservation& observation) const {
  if (settings_.method == FindMethod::combined) {
    if (observation.beams.empty()) return std::nullopt;
    return range_agreement(mode.pose, mode.wheel_scale, observation.beams, walls_, kSharp)
        .explained;
  }
  if (observation.sections.empty()) return std::nullopt;
  return orientation_importance(mode.pose, observation.sections, walls_, settings_.view_reach_m);
}

// What is found is doubted only when it explains less than it used to; a known start is believed.
bool WallFilter::is_challenged() const {
  if (watch_.is_found()) return watch_.is_doubtful();
  return !settings_.start || watch_.was_found();
}

// Challengers are drawn from the whole area by what this frame shows, and get the part of the
// belief that they earn by explaining the way behind.
void WallFilter::challenge(const WallObservation& observation) {
  const std::size_t count = std::max<std::size_t>(1, settings_.particles / kParticlesPerChallenger);
  ParticleCloud challengers = proposed_cloud(kChallengerCandidates * count, observation, walls_,
                                             area_, settings_.view_reach_m, random_);
  draw_wheel_scales(challengers, kWheelScaleSigma, random_);
  weigh_by_evidence(challengers, observation, kCandidateWayM);
  challengers = resampled(challengers, count, random_);
  weigh_by_history(challengers);
  challengers = resampled(challengers, count, random_);
  scatter_cloud(challengers, kChallengerSigmaM, kChallengerSigmaRad, random_);
  ParticleCloud defenders = resampled(cloud_, kDefenders, random_);

  const double lead =
      weigh_by_history(challengers) - weigh_by_history(defenders) - kDefendersAdvantage;
  const double part = std::min(1 / (1 + std::exp(-lead)), kMaxChallengedPart);
  for (Particle& particle : cloud_) particle.weight *= 1 - part;
  for (Particle& challenger : challengers) {
    challenger.weight *= part;
    cloud_.push_back(challenger);
  }
}

void WallFilter::resample() {
  if (settings_.method == FindMethod::orientations) {
    cloud_ = resampled(cloud_, settings_.particles, random_);
    return;
  }
  const std::size_t enough =
      watch_.is_found() ? std::min(settings_.particles, enough_particles(cloud_, kBinM, kBinRad))
                        : settings_.particles;
  const auto count = static_cast<double>(cloud_.size());
  const bool is_uneven = effective_count(cloud_) < count / 2;
  const bool are_few = cloud_.size() < enough / 2;
  if (is_uneven || are_few || cloud_.size() > enough) cloud_ = resampled(cloud_, enough, random_);
}

}  // namespace milepost
