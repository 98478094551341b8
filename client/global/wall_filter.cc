#include "client/global/wall_filter.h"

#include <algorithm>
#include <cmath>

#include "client/global/evidence.h"
#include "client/global/pose_proposals.h"
#include "client/global/wheel_errors.h"
#include "schema/geo/geodesy.h"

namespace milepost {
namespace {

constexpr std::size_t kStartCandidates = 10;  // for each particle
constexpr std::size_t kParticlesPerChallenger = 10;
constexpr double kFoundLead = 4;  // of log-likelihood over any other place

constexpr double kBinM = 1;
constexpr double kBinRad = 5 * kRadPerDeg;

}  // namespace

WallFilter::WallFilter(const WallIndex& walls, const PlanBox& area, const FilterSettings& settings)
    : walls_(walls),
      area_(area),
      settings_(settings),
      random_(settings.seed),
      cloud_(first_cloud(settings, area, random_)),
      watch_(watch_settings(settings)),
      history_(HistorySettings()),
      contest_(walls, area, settings.view_reach_m,
               std::max<std::size_t>(1, settings.particles / kParticlesPerChallenger)),
      is_started_(settings.start.has_value()) {
  draw_wheel_scales(cloud_, kWheelScaleSigma, random_);
}

Found WallFilter::update(const WallObservation& observation, const WheelMotion& motion) {
  way_m_ += std::abs(motion.distance_m);
  if (is_moving(motion)) {
    const bool is_about_start = settings_.start && !watch_.was_found();
    move_cloud(cloud_, motion, kWheelNoise, walls_, area_,
               is_about_start ? Crossing::dropped : Crossing::drawn_anew, random_);
    contest_.move(motion, random_);
  }
  const bool is_sight = history_.add(observation, motion);
  if (!is_started_ && !observation.beams.empty() && !observation.sections.empty()) {
    start_from(observation);
  } else {
    weigh_by_way(observation, std::min(way_m_, kMaxEvidenceWayM));
  }
  if (!observation.beams.empty()) way_m_ = 0;

  const BeliefMode mode = densest_mode(cloud_, {});
  const FindStatus status =
      watch_.observe(mode, explained_by(mode, observation), is_rivalled(), motion);
  if (is_sight && !observation.sections.empty() && is_challenged()) {
    contest_.hold(cloud_, mode.pose, observation, history_, random_);
  }
  resample();
  return {status, mode, watch_.explained()};
}

// A frame weighs by the way driven.
void WallFilter::weigh_by_way(const WallObservation& observation, double way_m) {
  EvidenceSettings evidence;
  evidence.ranges = watch_.is_found() ? kSharpRanges : kBroadRanges;
  evidence.view_reach_m = settings_.view_reach_m;
  weigh_by_evidence(cloud_, observation, way_m, walls_, evidence);
}

void WallFilter::start_from(const WallObservation& observation) {
  cloud_ = proposed_cloud(kStartCandidates * settings_.particles, observation, walls_, area_,
                          settings_.view_reach_m, random_);
  draw_wheel_scales(cloud_, kWheelScaleSigma, random_);
  weigh_by_way(observation, kCandidateWayM);
  is_started_ = true;
}

std::optional<double> WallFilter::explained_by(const BeliefMode& mode,
                                               const WallObservation& observation) const {
  if (observation.beams.empty()) return std::nullopt;
  return range_agreement(mode.pose, mode.wheel_scale, observation.beams, walls_, kSharpRanges)
      .explained;
}

// Whether another place explains the way behind nearly as well. Only where others are looked for.
bool WallFilter::is_rivalled() const { return is_challenged() && contest_.lead() < kFoundLead; }

// What is found is doubted only when it explains less than it used to; a known start is believed.
bool WallFilter::is_challenged() const {
  if (watch_.is_found()) return watch_.is_doubtful();
  return !settings_.start || watch_.was_found();
}

void WallFilter::resample() {
  const std::size_t enough =
      watch_.is_found() ? std::min(settings_.particles, enough_particles(cloud_, kBinM, kBinRad))
                        : settings_.particles;
  const auto count = static_cast<double>(cloud_.size());
  const bool is_uneven = effective_count(cloud_) < count / 2;
  const bool are_few = cloud_.size() < enough / 2;
  if (is_uneven || are_few || cloud_.size() > enough) cloud_ = resampled(cloud_, enough, random_);
}

FindMethod combined_method() {
  return {.with_beams = true, .make_filter = make_plan_filter<WallFilter>};
}

}  // namespace milepost
