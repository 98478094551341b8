#include "client/global/contest.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "client/global/pose_proposals.h"
#include "client/global/wheel_errors.h"

namespace milepost {
namespace {

constexpr std::size_t kCandidates = 5;  // for each challenger
constexpr double kScatterM = 1.5;       // how far challengers lie from the best place about
constexpr double kScatterRad = 2 * kRadPerDeg;
constexpr std::size_t kDefenders = 100;    // particles of the belief that they are held against
constexpr double kDefendersAdvantage = 1;  // of log-likelihood
constexpr double kHistoryPart = 0.5;       // of the evidence of the way behind: wheels err
constexpr double kMaxPart = 0.5;           // of the belief, that challengers can earn at once

constexpr double kElsewhereM = 5;
constexpr double kElsewhereRad = 0.35;
constexpr double kRivalScatterM = 0.5;
constexpr double kRivalScatterRad = 1 * kRadPerDeg;

// Of the particles that lie in another place or look elsewhere; none where none do.
ParticleCloud resampled_elsewhere(const ParticleCloud& cloud, const PlanPose& place,
                                  std::size_t count, Random& random) {
  ParticleCloud others = cloud;
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

Contest::Contest(const WallIndex& walls, PlanBox area, double view_reach_m, std::size_t count)
    : walls_(walls), area_(std::move(area)), count_(count) {
  evidence_.ranges = kBroadRanges;
  evidence_.view_reach_m = view_reach_m;
}

void Contest::move(const WheelMotion& motion, Random& random) {
  if (rivals_.empty()) return;
  move_cloud(rivals_, motion, kWheelNoise, walls_, area_, Crossing::dropped, random);
}

void Contest::hold(ParticleCloud& belief, const PlanPose& mode, const WallObservation& observation,
                   const SightHistory& history, Random& random) {
  ParticleCloud challengers = drawn(observation, random);
  challengers.insert(challengers.end(), rivals_.begin(), rivals_.end());
  for (Particle& challenger : challengers) challenger.weight = 1;
  weigh_cloud(challengers, of_the_way(challengers, history));
  rivals_ = resampled_elsewhere(challengers, mode, count_, random);
  scatter_cloud(rivals_, kRivalScatterM, kRivalScatterRad, random);
  challengers = resampled(challengers, count_, random);
  scatter_cloud(challengers, kScatterM, kScatterRad, random);
  ParticleCloud defenders = resampled(belief, kDefenders, random);

  const std::vector<double> of_defenders = of_the_way(defenders, history);
  if (!rivals_.empty()) {
    const std::vector<double> of_rivals = of_the_way(rivals_, history);
    lead_ = std::ranges::max(of_defenders) - std::ranges::max(of_rivals);
  }
  const double challengers_lead = weigh_cloud(challengers, of_the_way(challengers, history)) -
                                  weigh_cloud(defenders, of_defenders) - kDefendersAdvantage;
  const double part = std::min(1 / (1 + std::exp(-challengers_lead)), kMaxPart);
  for (Particle& particle : belief) particle.weight *= 1 - part;
  for (Particle& challenger : challengers) {
    challenger.weight *= part;
    belief.push_back(challenger);
  }
}

ParticleCloud Contest::drawn(const WallObservation& observation, Random& random) const {
  ParticleCloud candidates = proposed_cloud(kCandidates * count_, observation, walls_, area_,
                                            evidence_.view_reach_m, random);
  draw_wheel_scales(candidates, kWheelScaleSigma, random);
  weigh_by_evidence(candidates, observation, kCandidateWayM, walls_, evidence_);
  return resampled(candidates, count_, random);
}

// The log-likelihood of each particle over the way behind.
std::vector<double> Contest::of_the_way(const ParticleCloud& cloud,
                                        const SightHistory& history) const {
  EvidenceSettings evidence = evidence_;
  evidence.per_beam *= static_cast<double>(history.each_beam());
  std::vector<double> log_likelihoods(cloud.size(), 0);
  for (const PastSight& sight : history.sights()) {
    const double way_m = kHistoryPart * std::min(sight.way_m, kMaxEvidenceWayM);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const double scale = cloud[i].wheel_scale;
      const PlanPose pose = history.pose_then(cloud[i].pose, scale, sight);
      log_likelihoods[i] +=
          way_m * evidence_per_m(pose, scale, sight.observation, walls_, evidence);
    }
  }
  return log_likelihoods;
}

}  // namespace milepost
