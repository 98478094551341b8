#include "client/find/wall_filter.h"

#include <algorithm>
#include <cmath>

#include "client/find/orientation_importance.h"
#include "client/find/pose_proposals.h"
#include "schema/geo/geodesy.h"

namespace milepost {
namespace {

// The paper, section IV, for its method; the second is for wheels as they are.
constexpr MotionNoise kPaperNoise{0.1, 0, 5 * kRadPerDeg};
constexpr MotionNoise kWheelNoise{0.1, 0.03, 1 * kRadPerDeg};

// Standing still, particles stay: noise would only spread them.
constexpr double kStandsM = 0.01;
constexpr double kStandsRad = 0.001;

// What a metre of way adds to the evidence, as a part of what its beams say: points seen in frame
// after frame on the same walls, by the same wheels, are hardly news.
constexpr double kEvidencePerM = 0.007;
constexpr double kTrackedEvidencePerM = 0.03;
constexpr double kMaxEvidenceWayM = 5;

// Broad while few particles have to cover an area, sharp about a place that is found.
constexpr RangeSettings kBroad{1.5, 0.05};
constexpr RangeSettings kSharp{0.5, 0.02};

constexpr std::size_t kStartCandidates = 10;  // for each particle
constexpr std::size_t kParticlesPerChallenger = 10;
constexpr std::size_t kChallengerCandidates = 5;
constexpr double kCandidateWayM = 4;     // how much a frame says of them
constexpr double kChallengedPerS = 0.1;  // of the belief, while nothing is found
constexpr double kDoubtedPerS = 0.25;    // ... what was found is doubted altogether

constexpr double kBinM = 1;
constexpr double kBinRad = 5 * kRadPerDeg;

}  // namespace

WallFilter::WallFilter(const WallIndex& walls, const PlanBox& area, const FilterSettings& settings)
    : walls_(walls),
      area_(area),
      settings_(settings),
      random_(settings.seed),
      cloud_(settings.start ? cloud_about(*settings.start, settings.particles, random_)
                            : uniform_cloud(settings.particles, area, random_)),
      watch_(settings.watch),
      is_started_(settings.start.has_value()) {}

Found WallFilter::update(const WallObservation& observation, const WheelMotion& motion) {
  const bool is_ours = settings_.method == FindMethod::ranges;
  way_m_ += std::abs(motion.distance_m);
  duration_s_ += motion.duration_s;
  if (std::abs(motion.distance_m) > kStandsM || std::abs(motion.turn_rad) > kStandsRad) {
    move_cloud(cloud_, motion, is_ours ? kWheelNoise : kPaperNoise, walls_, area_, random_);
  }
  const bool has_both = !observation.beams.empty() && !observation.sections.empty();
  if (is_ours && !is_started_ && has_both) {
    start_from(observation);
  } else {
    const bool found = watch_.is_found();
    weigh(cloud_, observation,
          {std::min(way_m_, kMaxEvidenceWayM) * (found ? kTrackedEvidencePerM : kEvidencePerM),
           found ? kSharp : kBroad});
  }
  if (!observation.beams.empty()) way_m_ = 0;

  const BeliefMode mode = densest_mode(cloud_, {});
  const FindStatus status = watch_.observe(mode, explained_by(mode.pose, observation), motion);
  if (is_ours && has_both) challenge(observation, std::exchange(duration_s_, 0));
  resample();
  return {status, mode, watch_.explained()};
}

void WallFilter::start_from(const WallObservation& observation) {
  cloud_ = oriented_cloud(kStartCandidates * settings_.particles, observation.sections, walls_,
                          area_, settings_.view_reach_m, random_);
  weigh(cloud_, observation, {kCandidateWayM * kEvidencePerM, kBroad});
  is_started_ = true;
}

void WallFilter::weigh(ParticleCloud& cloud, const WallObservation& observation,
                       const Weighing& weighing) const {
  std::vector<double> log_likelihoods(cloud.size(), 0);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const PlanPose& pose = cloud[i].pose;
    if (settings_.method == FindMethod::ranges) {
      log_likelihoods[i] =
          weighing.evidence *
          range_agreement(pose, observation.beams, walls_, weighing.ranges).log_likelihood;
    } else if (!observation.sections.empty()) {
      // Eq. 4; a particle that explains nothing keeps a trace, so that the weights have a sum.
      log_likelihoods[i] = std::log(1e-9 + orientation_importance(pose, observation.sections,
                                                                  walls_, settings_.view_reach_m));
    }
  }
  weigh_cloud(cloud, log_likelihoods);
}

std::optional<double> WallFilter::explained_by(const PlanPose& pose,
                                               const WallObservation& observation) const {
  if (settings_.method == FindMethod::ranges) {
    if (observation.beams.empty()) return std::nullopt;
    return range_agreement(pose, observation.beams, walls_, kSharp).explained;
  }
  if (observation.sections.empty()) return std::nullopt;
  return orientation_importance(pose, observation.sections, walls_, settings_.view_reach_m);
}

// The part of the belief that goes to challengers. A known start is not challenged.
double WallFilter::challenged_per_s() const {
  if (watch_.is_found()) return kDoubtedPerS * watch_.doubt();
  return settings_.start && !watch_.was_found() ? 0 : kChallengedPerS;
}

void WallFilter::challenge(const WallObservation& observation, double duration_s) {
  const double mass = 1 - std::exp(-challenged_per_s() * duration_s);
  if (mass <= 0) return;
  const std::size_t count = std::max<std::size_t>(1, settings_.particles / kParticlesPerChallenger);
  ParticleCloud candidates = oriented_cloud(kChallengerCandidates * count, observation.sections,
                                            walls_, area_, settings_.view_reach_m, random_);
  weigh(candidates, observation, {kCandidateWayM * kEvidencePerM, kBroad});
  for (Particle& particle : cloud_) particle.weight *= 1 - mass;
  for (Particle challenger : resampled(candidates, count, random_)) {
    challenger.weight *= mass;
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
  if (is_uneven || cloud_.size() > enough) cloud_ = resampled(cloud_, enough, random_);
}

}  // namespace milepost
