#include "mapper/pipeline/pass_comparison.h"

#include <algorithm>
#include <map>

#include <opencv2/calib3d.hpp>

#include "schema/feature/descriptor_index.h"
#include "schema/geo/geodesy.h"

namespace milepost {
namespace {

constexpr std::size_t kFramesCompared = 8;    // of a pass
constexpr double kSamePlaceM = 10;            // greatest distance of two frames compared
constexpr std::size_t kSeeingFeatures = 150;  // a frame with fewer does not tell
// Of matches that agree with one epipolar geometry. By chance, of frames of other roads, up to 23
// and 45 % were seen to; of one street, 94 %.
constexpr std::size_t kSameInliers = 30;
constexpr double kSameShare = 0.6;

// Two frames taken in the same place, by their indices in the drives.
struct FramePair {
  std::size_t a = 0, b = 0;
};

std::vector<FramePair> pairs_of(const Drive& drive_a, const std::vector<std::size_t>& frames_a,
                                const Drive& drive_b, const std::vector<std::size_t>& frames_b) {
  std::vector<FramePair> pairs;
  for (const std::size_t a : spread_evenly(frames_a, kFramesCompared)) {
    const auto distance_m = [&](std::size_t b) {
      return geodesic_distance_m(drive_a.frames[a].position, drive_b.frames[b].position);
    };
    const std::size_t nearest = *std::ranges::min_element(frames_b, {}, distance_m);
    if (distance_m(nearest) <= kSamePlaceM) pairs.push_back({a, nearest});
  }
  return pairs;
}

// The matches that pass the ratio test (Lowe, 2004), each feature of `b` in one at most.
struct PointPairs {
  std::vector<cv::Point2f> a, b;
};

PointPairs matches_of(const FeatureSet& a, const FeatureSet& b, double max_distance_ratio) {
  const DescriptorIndex index(b.descriptors, {});
  const auto neighbours = index.nearest(a.descriptors, 2);
  std::map<std::size_t, std::size_t> best;  // feature of b -> of a
  const auto distance_of = [&](std::size_t feature) {
    return neighbours[feature].front().distance_squared;
  };
  for (std::size_t i = 0; i < neighbours.size(); ++i) {
    if (neighbours[i].size() < 2) continue;
    const double ratio_squared = max_distance_ratio * max_distance_ratio;
    if (distance_of(i) > ratio_squared * neighbours[i][1].distance_squared) continue;
    const auto [known, is_new] = best.try_emplace(neighbours[i].front().index, i);
    if (!is_new && distance_of(i) < distance_of(known->second)) known->second = i;
  }
  PointPairs pairs;
  for (const auto& [of_b, of_a] : best) {
    pairs.a.emplace_back(a.features[of_a].x_px, a.features[of_a].y_px);
    pairs.b.emplace_back(b.features[of_b].x_px, b.features[of_b].y_px);
  }
  return pairs;
}

// Whether enough matches agree with one fundamental matrix. Deterministic.
bool agree(const PointPairs& pairs) {
  constexpr double kMaxDistancePx = 2;
  constexpr double kConfidence = 0.999;
  if (pairs.a.size() < kSameInliers) return false;
  std::vector<unsigned char> is_inlier;
  cv::findFundamentalMat(pairs.a, pairs.b, cv::FM_RANSAC, kMaxDistancePx, kConfidence, is_inlier);
  const auto inliers = static_cast<std::size_t>(std::ranges::count(is_inlier, 1));
  return inliers >= kSameInliers &&
         static_cast<double>(inliers) >= kSameShare * static_cast<double>(pairs.a.size());
}

}  // namespace

std::optional<bool> PassComparison::show_the_same_road(const Pass& a, const Pass& b) {
  const auto pairs =
      pairs_of(frames_.drive_of(a), frames_.on(a), frames_.drive_of(b), frames_.on(b));
  std::vector<std::size_t> indices_a;
  std::vector<std::size_t> indices_b;
  for (const FramePair& pair : pairs) {
    indices_a.push_back(pair.a);
    indices_b.push_back(pair.b);
  }
  const auto features_a = frames_.features(a, indices_a, settings_.feature);
  const auto features_b = frames_.features(b, indices_b, settings_.feature);
  if (!features_a || !features_b) return std::nullopt;
  std::size_t same = 0;
  std::size_t other = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const FeatureSet& of_a = (*features_a)[i];
    const FeatureSet& of_b = (*features_b)[i];
    if (std::min(of_a.size(), of_b.size()) < kSeeingFeatures) continue;
    ++(agree(matches_of(of_a, of_b, settings_.follow.max_distance_ratio)) ? same : other);
  }
  if (same > 1 && same > other) return true;
  constexpr std::size_t kLeastPairs = 3;
  if (same == 0 && other >= kLeastPairs && 2 * other > pairs.size()) return false;
  return std::nullopt;
}

}  // namespace milepost
