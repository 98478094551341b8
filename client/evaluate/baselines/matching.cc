#include "client/evaluate/baselines/matching.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <unordered_map>

namespace milepost {
namespace {

constexpr double kMinSigmaM = 1e-3;  // lower bound of an estimate's sigma

struct Candidate {
  std::size_t tracklet = 0;
  float distance_squared = 0;
  double along_m = 0;  // the position of the camera that it implies
};

PositionEstimate regressed(const Tracklet& tracklet, ScaleModel model, double scale_px,
                           double scale_noise) {
  const double along_m = tracklet.along_estimate_m(model, scale_px);  // Eq. 3
  // d along = slope * d f(s); for both models |s * df/ds| = |f(s)|, so relative noise carries over.
  const double from_scale_m =
      scale_noise * std::abs(tracklet.slope * scale_variable(model, scale_px));
  return {along_m, std::max(std::hypot(tracklet.residual_sigma_m, from_scale_m), kMinSigmaM)};
}

// The frame of the observation with the closest scale; its uncertainty is the spacing of the
// frames.
PositionEstimate closest_observation(const Track& track, double scale_px) {
  const auto closest = std::ranges::min_element(track, {}, [&](const Observation& observation) {
    return std::abs(observation.feature.scale_px - scale_px);
  });
  const double length_m = track.back().along_m - track.front().along_m;
  return {closest->along_m, length_m / static_cast<double>(track.size() - 1)};
}

PositionEstimate estimate_from(const TrackletWindow& window, std::size_t tracklet, double scale_px,
                               const MatchSettings& settings) {
  return settings.estimation == Estimation::regression
             ? regressed(window.tracklets()[tracklet], window.model(), scale_px,
                         settings.scale_noise)
             : closest_observation(window.track(tracklet), scale_px);
}

bool fits(const Tracklet& tracklet, const Feature& feature, double scale_px, double pixel_margin_px,
          double scale_margin) {
  const PixelRange& pixels = tracklet.pixels;
  return scale_px >= tracklet.scale_min_px * (1 - scale_margin) &&
         scale_px <= tracklet.scale_max_px * (1 + scale_margin) &&
         feature.x_px >= pixels.x_min_px - pixel_margin_px &&
         feature.x_px <= pixels.x_max_px + pixel_margin_px &&
         feature.y_px >= pixels.y_min_px - pixel_margin_px &&
         feature.y_px <= pixels.y_max_px + pixel_margin_px;
}

// The nearest neighbour within the region if it passes the ratio test against the second there. If
// not all neighbours were examined, the last one bounds the distance of the others.
std::optional<Candidate> distinct_nearest(const std::vector<Neighbour>& neighbours, double scale_px,
                                          const TrackletWindow& window, const AlongRange& region,
                                          const MatchSettings& settings) {
  std::optional<Candidate> nearest;
  float second_squared = std::numeric_limits<float>::infinity();
  for (const Neighbour& neighbour : neighbours) {
    const std::size_t index = window.tracklet_of(neighbour.index);
    if (nearest && index == nearest->tracklet) continue;
    const Tracklet& tracklet = window.tracklets()[index];
    if (!tracklet.along.meets(region)) continue;
    const double along_m = tracklet.along_estimate_m(window.model(), scale_px);
    if (!nearest) {
      nearest = {index, neighbour.distance_squared, along_m};
    } else if (!(std::abs(along_m - nearest->along_m) < settings.same_place_m)) {
      second_squared = neighbour.distance_squared;
      break;
    }
  }
  if (!nearest) return std::nullopt;
  if (neighbours.size() == settings.neighbours) {
    second_squared = std::min(second_squared, neighbours.back().distance_squared);
  }
  const double ratio_squared = settings.max_distance_ratio * settings.max_distance_ratio;
  if (nearest->distance_squared > ratio_squared * second_squared) return std::nullopt;
  return nearest;
}

}  // namespace

std::vector<TrackletMatch> match_tracklets(const FeatureSet& query, double scale_ratio,
                                           int image_width_px, const TrackletWindow& window,
                                           const AlongRange& region,
                                           const MatchSettings& settings) {
  const auto neighbours = window.index().nearest(query.descriptors, settings.neighbours);
  const double pixel_margin_px = settings.pixel_margin * image_width_px;

  struct Best {
    std::size_t feature;
    float distance_squared;
  };
  std::unordered_map<std::size_t, Best> best_of_tracklet;
  for (std::size_t i = 0; i < query.size(); ++i) {
    const Feature& feature = query.features[i];
    const double scale_px = scale_ratio * feature.scale_px;
    const auto candidate = distinct_nearest(neighbours[i], scale_px, window, region, settings);
    if (!candidate) continue;
    if (!fits(window.tracklets()[candidate->tracklet], feature, scale_px, pixel_margin_px,
              settings.scale_range_margin)) {
      continue;
    }
    const auto [best, is_new] =
        best_of_tracklet.try_emplace(candidate->tracklet, Best{i, candidate->distance_squared});
    if (!is_new && candidate->distance_squared < best->second.distance_squared) {
      best->second = {i, candidate->distance_squared};
    }
  }

  std::vector<TrackletMatch> matches;
  matches.reserve(best_of_tracklet.size());
  const AlongRange believable = region.widened(settings.region_margin_m);
  for (const auto& [tracklet, best] : best_of_tracklet) {
    const double scale_px = scale_ratio * query.features[best.feature].scale_px;
    const PositionEstimate estimate = estimate_from(window, tracklet, scale_px, settings);
    if (believable.contains(estimate.along_m))
      matches.push_back({best.feature, tracklet, scale_px, estimate});
  }
  std::sort(matches.begin(), matches.end(), [](const TrackletMatch& a, const TrackletMatch& b) {
    return a.feature < b.feature;  // a deterministic order, independent of hashing
  });
  return matches;
}

}  // namespace milepost
