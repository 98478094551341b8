#include "mapper/tracklets/feature_tracker.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "mapper/tracklets/motion.h"
#include "schema/feature/feature_grid.h"

namespace milepost {
namespace {

bool has_motion(const Track& track) { return track.size() >= 2; }

// SIFT gives a keypoint with several orientations several descriptors at one position.
bool same_place(const Feature& a, const Feature& b) {
  return std::abs(a.x_px - b.x_px) < 1 && std::abs(a.y_px - b.y_px) < 1;
}

}  // namespace

FeatureTracker::FeatureTracker(const FeatureTrackingSettings& settings, int image_width_px)
    : settings_(settings), image_width_px_(image_width_px) {}

std::vector<Track> FeatureTracker::add(const FeatureSet& frame, double along_m) {
  std::vector<Link> links = links_by_ratio(frame);
  const std::vector<Link> moving = links_by_motion(frame, along_m);
  links.insert(links.end(), moving.begin(), moving.end());
  std::sort(links.begin(), links.end(), [](const Link& a, const Link& b) {
    return std::tie(a.distance_squared, a.track, a.feature) <
           std::tie(b.distance_squared, b.track, b.feature);
  });

  constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> feature_of_track(open_.size(), kNone);
  std::vector<bool> taken(frame.size(), false);
  for (const Link& link : links) {  // the best first; each track and each feature once
    if (feature_of_track[link.track] != kNone || taken[link.feature]) continue;
    feature_of_track[link.track] = link.feature;
    taken[link.feature] = true;
  }

  std::vector<Track> ended;
  std::vector<Track> open;
  for (std::size_t t = 0; t < open_.size(); ++t) {
    const std::size_t i = feature_of_track[t];
    if (i == kNone) {
      keep_if_long(std::move(open_[t]), ended);
    } else {
      open_[t].push_back({frame.features[i], frame.descriptors[i], along_m});
      open.push_back(std::move(open_[t]));
    }
  }
  for (std::size_t i = 0; i < frame.size(); ++i) {
    if (!taken[i]) open.push_back({{frame.features[i], frame.descriptors[i], along_m}});
  }
  open_ = std::move(open);
  return ended;
}

std::vector<Track> FeatureTracker::finish() {
  std::vector<Track> ended;
  for (Track& track : open_) keep_if_long(std::move(track), ended);
  open_.clear();
  return ended;
}

double FeatureTracker::oldest_open_along_m() const {
  double oldest_m = std::numeric_limits<double>::infinity();
  for (const Track& track : open_) oldest_m = std::min(oldest_m, track.front().along_m);
  return oldest_m;
}

std::vector<FeatureTracker::Link> FeatureTracker::links_by_ratio(const FeatureSet& frame) const {
  std::vector<std::size_t> tracks;
  std::vector<Descriptor> queries;
  for (std::size_t t = 0; t < open_.size(); ++t) {
    if (has_motion(open_[t])) continue;
    tracks.push_back(t);
    queries.push_back(open_[t].back().descriptor);
  }
  const DescriptorIndex index(frame.descriptors, settings_.index);
  const auto neighbours = index.nearest(queries, 2);
  const auto max_ratio_squared = static_cast<float>(std::pow(settings_.max_distance_ratio, 2));
  const double max_displacement_px = settings_.max_displacement * image_width_px_;

  std::vector<Link> links;
  for (std::size_t q = 0; q < queries.size(); ++q) {
    if (neighbours[q].size() < 2) continue;
    const Neighbour& best = neighbours[q][0];
    const Feature& before = open_[tracks[q]].back().feature;
    const Feature& after = frame.features[best.index];
    if (best.distance_squared > max_ratio_squared * neighbours[q][1].distance_squared) continue;
    if (best.distance_squared > std::pow(settings_.max_distance, 2)) continue;
    if (!scale_grows_plausibly(before, after)) continue;
    if (std::hypot(after.x_px - before.x_px, after.y_px - before.y_px) > max_displacement_px)
      continue;
    links.push_back({tracks[q], best.index, best.distance_squared});
  }
  return links;
}

std::vector<FeatureTracker::Link> FeatureTracker::links_by_motion(const FeatureSet& frame,
                                                                  double along_m) const {
  const FeatureGrid grid(frame.features);
  const auto max_ratio_squared = static_cast<float>(std::pow(settings_.max_distance_ratio, 2));
  const auto max_squared = static_cast<float>(std::pow(settings_.max_distance, 2));
  std::vector<Link> links;
  for (std::size_t t = 0; t < open_.size(); ++t) {
    if (!has_motion(open_[t])) continue;
    const Observation& latest = open_[t].back();
    const PredictedPosition predicted = predict_position(open_[t], along_m);
    const auto radius_px = static_cast<float>(settings_.search_radius_px +
                                              settings_.search_per_motion * predicted.motion_px);
    Link best{t, 0, max_squared};
    float second_squared = max_squared;
    bool found = false;
    grid.visit_near(predicted.x_px, predicted.y_px, radius_px, [&](std::size_t i) {
      const Feature& after = frame.features[i];
      if (std::hypot(after.x_px - predicted.x_px, after.y_px - predicted.y_px) > radius_px) return;
      if (!scale_grows_plausibly(latest.feature, after)) return;
      const float squared = distance_squared(latest.descriptor, frame.descriptors[i]);
      if (squared < best.distance_squared) {
        if (found && !same_place(after, frame.features[best.feature])) {
          second_squared = best.distance_squared;
        }
        best = {t, i, squared};
        found = true;
      } else if (squared < second_squared && !same_place(after, frame.features[best.feature])) {
        second_squared = squared;
      }
    });
    if (found && best.distance_squared <= max_ratio_squared * second_squared) links.push_back(best);
  }
  return links;
}

bool FeatureTracker::scale_grows_plausibly(const Feature& before, const Feature& after) const {
  const double growth = static_cast<double>(after.scale_px) / before.scale_px;
  return growth >= settings_.min_scale_growth && growth <= settings_.max_scale_growth;
}

void FeatureTracker::keep_if_long(Track track, std::vector<Track>& kept) const {
  if (track.size() >= settings_.min_observations) kept.push_back(std::move(track));
}

}  // namespace milepost
