#include "client/localize/landmark_matching.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Dense>

namespace milepost {
namespace {

constexpr int kFar = std::numeric_limits<int>::max();

bool mapped_in(const LocalLandmark& landmark, const AlongRange& region, double margin_m) {
  return landmark.along.widened(margin_m).meets(region);
}

// Saturates: with a very small quantization step of the map no int holds the square.
int squared_steps(double distance, double quantization_step) {
  return static_cast<int>(std::min<double>(kFar, std::pow(distance / quantization_step, 2)));
}

// Nearest neighbour and Lowe's ratio test against the nearest candidate at another place.
class RatioTest {
 public:
  template <class SamePlace>
  void offer(int squared, std::size_t candidate, const SamePlace& same_place) {
    if (squared >= second_) return;
    const bool other_place = best_ == kFar || !same_place(nearest_, candidate);
    if (squared < best_) {
      if (other_place) second_ = best_;
      best_ = squared;
      nearest_ = candidate;
    } else if (other_place) {
      second_ = squared;
    }
  }

  // Whether the nearest is near enough, and nearer than the second by the ratio of distances.
  bool is_distinct(int max_squared, double max_ratio) const {
    return best_ < max_squared && best_ <= max_ratio * max_ratio * second_;
  }
  std::size_t nearest() const { return nearest_; }
  int squared() const { return best_; }

 private:
  int best_ = kFar;  // squared distances
  int second_ = kFar;
  std::size_t nearest_ = 0;
};

// The search gate of a landmark in the image.
struct SearchGate {
  Eigen::Vector2d pixel;
  double radius_px = 0;
  double scale_px = 0;
};

std::optional<SearchGate> search_gate(const LocalLandmark& landmark, const PoseBelief& belief,
                                      const Pinhole& given, const LandmarkMatchSettings& settings) {
  const CameraPose pose = belief.pose();
  const Pinhole camera = belief.camera(given);
  const Eigen::Matrix3d rotation = camera_from_enu(pose);
  const Eigen::Vector3d seen = rotation * (landmark.enu_m - pose.enu_m);
  if (!(seen.z() > kNearestSeenM)) return std::nullopt;
  SearchGate expected;
  expected.pixel = camera.project(seen);
  expected.scale_px = landmark.size_m * camera.focal_px() / seen.z();
  // Propagates position and angle uncertainty to the image.
  const double focal_px = camera.focal_px();
  const Eigen::Matrix3d position = belief.P.topLeftCorner<3, 3>();
  const Eigen::Vector3d ray = (landmark.enu_m - pose.enu_m).normalized();
  const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - ray * ray.transpose();
  const double across_m = std::sqrt((across * position * across).trace());
  const double angle_rad = std::sqrt(belief.P(kHeading, kHeading) + belief.P(kPitch, kPitch));
  const double depth_m = landmark.depth_sigma_m * (across * landmark.mapping_ray).norm();
  const double sigma_px =
      focal_px * std::hypot(std::hypot(across_m, depth_m) / seen.z(), angle_rad);
  if (!std::isfinite(sigma_px)) return std::nullopt;
  expected.radius_px =
      std::clamp(settings.gate_sigmas * sigma_px, settings.min_gate_px, settings.max_gate_px);
  return expected;
}

}  // namespace

CompactFrame::CompactFrame(const FeatureSet& set, const PcaProjection& projection)
    : features(set.features), grid(set.features) {
  descriptors.reserve(set.size());
  for (const Descriptor& descriptor : set.descriptors) {
    descriptors.push_back(projection.compact(descriptor));
  }
}

std::vector<LandmarkMatch> match_global(const CompactFrame& frame, double quantization_step,
                                        const std::vector<LocalLandmark>& landmarks,
                                        const AlongRange& region,
                                        const LandmarkMatchSettings& settings) {
  std::vector<std::size_t> mapped;
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    if (mapped_in(landmarks[i], region, settings.along_margin_m)) mapped.push_back(i);
  }
  const int max_squared = squared_steps(settings.max_distance, quantization_step);
  const auto same_place = [&](std::size_t a, std::size_t b) {
    return (landmarks[a].enu_m - landmarks[b].enu_m).norm() <= settings.same_place_m;
  };
  std::vector<LandmarkMatch> matches;
  for (std::size_t f = 0; f < frame.features.size(); ++f) {
    RatioTest alike;
    for (const std::size_t i : mapped) {
      alike.offer(distance_squared(frame.descriptors[f], landmarks[i].descriptor), i, same_place);
    }
    if (alike.is_distinct(max_squared, settings.max_distance_ratio)) {
      matches.push_back({f, alike.nearest()});
    }
  }
  return matches;
}

std::vector<LandmarkMatch> match_guided(const CompactFrame& frame, double quantization_step,
                                        const std::vector<LocalLandmark>& landmarks,
                                        const AlongRange& region, const PoseBelief& belief,
                                        const Pinhole& camera,
                                        const LandmarkMatchSettings& settings) {
  struct Claim {
    int squared = kFar;
    std::size_t landmark = 0;
  };
  std::vector<Claim> claims(frame.features.size());  // by feature: its nearest landmark
  const int max_squared = squared_steps(settings.max_distance, quantization_step);
  constexpr double kSamePlacePx = 2;
  const auto same_place = [&](std::size_t a, std::size_t b) {
    return std::hypot(frame.features[a].x_px - frame.features[b].x_px,
                      frame.features[a].y_px - frame.features[b].y_px) <= kSamePlacePx;
  };
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    const LocalLandmark& landmark = landmarks[i];
    if (!mapped_in(landmark, region, settings.along_margin_m)) continue;
    const auto expected = search_gate(landmark, belief, camera, settings);
    if (!expected) continue;
    RatioTest alike;
    frame.grid.visit_near(
        static_cast<float>(expected->pixel.x()), static_cast<float>(expected->pixel.y()),
        static_cast<float>(expected->radius_px), [&](std::size_t f) {
          const Feature& feature = frame.features[f];
          const Eigen::Vector2d off = Eigen::Vector2d(feature.x_px, feature.y_px) - expected->pixel;
          if (off.norm() > expected->radius_px) return;
          if (std::abs(std::log(feature.scale_px / expected->scale_px)) > settings.max_log_scale)
            return;
          alike.offer(distance_squared(frame.descriptors[f], landmark.descriptor), f, same_place);
        });
    if (!alike.is_distinct(max_squared, settings.max_guided_ratio)) continue;
    Claim& claim = claims[alike.nearest()];
    if (alike.squared() < claim.squared) claim = {alike.squared(), i};
  }
  std::vector<LandmarkMatch> matches;
  for (std::size_t f = 0; f < claims.size(); ++f) {
    if (claims[f].squared != kFar) matches.push_back({f, claims[f].landmark});
  }
  return matches;
}

}  // namespace milepost
