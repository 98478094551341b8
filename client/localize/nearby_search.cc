#include "client/localize/nearby_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "schema/geo/near.h"

namespace milepost {
namespace {

constexpr double kMaxStartTurnDeg = 60;    // between a known heading and that of a segment
constexpr std::size_t kMaxCandidates = 4;  // segments searched

// Whether the segment leads in the vehicle's heading, if that is known.
bool leads_ahead(const RouteLine& line, double along_m, const GnssFix& vehicle) {
  if (!vehicle.heading_deg) return true;
  const double turn_deg = *vehicle.heading_deg - line.heading_deg_at(along_m);
  return std::abs(std::remainder(turn_deg, 360)) <= kMaxStartTurnDeg;
}

}  // namespace

Surroundings NearbySearch::surroundings(const GnssFix& around) const {
  const double radius_m = settings_.start_radius_m + settings_.start_sigmas * around.sigma_m;
  return {around.position,
          std::min(radius_m, kMaxNearRadiusM - settings_.provider.surroundings_margin_m)};
}

std::optional<std::vector<NearbySegment>> NearbySearch::segments(const HeldMap& held,
                                                                 const GnssFix& around) const {
  auto near = held.segments_near(surroundings(around));
  if (near && near->size() > kMaxCandidates) near->resize(kMaxCandidates);
  return near;
}

AlongRange NearbySearch::range(double nearest_along_m, const GnssFix& around,
                               double timestamp_s) const {
  const double age_s = std::max(0.0, timestamp_s - around.timestamp_s);
  const double reach_m = settings_.start_sigmas * around.sigma_m + settings_.start_reach_m +
                         settings_.receiver.speed_mps * age_s;
  return AlongRange{nearest_along_m, nearest_along_m}.widened(reach_m);
}

FoundNearby NearbySearch::search(SharedFrame& frame, const GnssFix& around) {
  FoundNearby found;
  const auto near = segments(frame.held(), around);
  if (!near) {
    found.failure = frame.held().around_failure;
    return found;
  }
  found.nearest_m =
      near->empty() ? std::numeric_limits<double>::infinity() : near->front().distance_m;
  for (const NearbySegment& where : *near) search_on(frame, where, around, found);
  return found;
}

void NearbySearch::search_on(SharedFrame& frame, const NearbySegment& where, const GnssFix& around,
                             FoundNearby& found) {
  const HeldSegment* held = frame.held().find({where.version, where.segment});
  if (held == nullptr || !held->layer) {
    if (held != nullptr && held->failure) found.failure = held->failure;
    return;
  }
  if (!leads_ahead(held->layer->line, where.along_m, around)) return;
  const Result<Relocalizer*> relocalizer = relocalizers_.on(held->layer);
  if (!relocalizer) {
    found.failure = relocalizer.error();
    return;
  }
  Relocalization relocalization =
      (*relocalizer)
          ->relocalize(frame, range(where.along_m, around, frame.timestamp_s()), std::nullopt);
  if (relocalization.failure) found.failure = relocalization.failure;
  for (RelocalizationCandidate& candidate : relocalization.candidates) {
    Hypothesis hypothesis{{.odds = LogOdds(settings_.odds),
                           .receiver = GnssLikelihood(settings_.receiver),
                           .timestamp_s = frame.timestamp_s(),
                           .measured = true,
                           .log_bayes_factor = candidate.log_bayes_factor,
                           .matches = candidate.matches},
                          std::move(candidate.tracker)};
    if (hypothesis.is_on_segment(hypothesis.tracker->pose()))
      found.hypotheses.push_back(std::move(hypothesis));
  }
}

}  // namespace milepost
