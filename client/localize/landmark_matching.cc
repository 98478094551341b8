#include "client/localize/landmark_matching.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Dense>

namespace milepost {
namespace {

constexpr int kFar = std::numeric_limits<int>::max();
constexpr double kNearestM = 0.5;

bool mapped_in(const PlacedLandmark& landmark, const AlongRange& region, double margin_m) {
  return landmark.along.widened(margin_m).meets(region);
}

int squared_steps(double distance, double codebook_step) {
  return static_cast<int>(std::pow(distance / codebook_step, 2));
}

// Where a landmark is expected in the image.
struct ExpectedSight {
  Eigen::Vector2d pixel;
  double radius_px = 0;
  double scale_px = 0;
};

std::optional<ExpectedSight> expected_sight(const PlacedLandmark& landmark,
                                            const PoseBelief& belief, const Pinhole& given,
                                            const LandmarkMatchSettings& settings) {
  const CameraPose pose = belief.pose();
  const Pinhole camera = belief.camera(given);
  const Eigen::Matrix3d rotation = camera_from_enu(pose);
  const Eigen::Vector3d seen = rotation * (landmark.enu_m - pose.enu_m);
  if (!(seen.z() > kNearestM)) return std::nullopt;
  ExpectedSight expected;
  expected.pixel = camera.pixel_of(seen);
  expected.scale_px = landmark.size_m * camera.focal_px() / seen.z();
  // What a metre moves the image by, in any direction, and what an angle does.
  const double focal_px = camera.focal_px();
  const Eigen::Matrix3d position = belief.covariance.topLeftCorner<3, 3>();
  const Eigen::Vector3d ray = (landmark.enu_m - pose.enu_m).normalized();
  const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - ray * ray.transpose();
  const double across_m = std::sqrt((across * position * across).trace());
  const double angle_rad =
      std::sqrt(belief.covariance(kHeading, kHeading) + belief.covariance(kPitch, kPitch));
  const double depth_m = landmark.depth_sigma_m * (across * landmark.mapping_ray).norm();
  const double sigma_px =
      focal_px * std::hypot(std::hypot(across_m, depth_m) / seen.z(), angle_rad);
  if (!std::isfinite(sigma_px)) return std::nullopt;
  expected.radius_px =
      std::clamp(settings.gate_sigmas * sigma_px, settings.min_gate_px, settings.max_gate_px);
  return expected;
}

}  // namespace

CompactFrame::CompactFrame(const FeatureSet& set, const Codebook& codebook)
    : features(set.features), grid(set.features) {
  descriptors.reserve(set.size());
  for (const Descriptor& descriptor : set.descriptors) {
    descriptors.push_back(codebook.compact(descriptor));
  }
}

std::vector<LandmarkMatch> match_anywhere(const CompactFrame& frame, double codebook_step,
                                          const std::vector<PlacedLandmark>& landmarks,
                                          const AlongRange& region,
                                          const LandmarkMatchSettings& settings) {
  std::vector<std::size_t> mapped;
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    if (mapped_in(landmarks[i], region, settings.along_margin_m)) mapped.push_back(i);
  }
  const int max_squared = squared_steps(settings.max_distance, codebook_step);
  const double max_ratio_squared = std::pow(settings.max_distance_ratio, 2);
  std::vector<LandmarkMatch> matches;
  for (std::size_t f = 0; f < frame.features.size(); ++f) {
    int best = kFar;
    int second = kFar;
    std::size_t nearest = landmarks.size();
    for (const std::size_t i : mapped) {
      const int squared = distance_squared(frame.descriptors[f], landmarks[i].descriptor);
      if (squared >= std::min(second, kFar)) continue;
      const bool other_place =
          nearest == landmarks.size() ||
          (landmarks[i].enu_m - landmarks[nearest].enu_m).norm() > settings.same_place_m;
      if (squared < best) {
        if (nearest != landmarks.size() && other_place) second = best;
        best = squared;
        nearest = i;
      } else if (other_place) {
        second = squared;
      }
    }
    if (best >= max_squared) continue;
    if (best <= max_ratio_squared * second) matches.push_back({f, nearest});
  }
  return matches;
}

std::vector<LandmarkMatch> match_expected(const CompactFrame& frame, double codebook_step,
                                          const std::vector<PlacedLandmark>& landmarks,
                                          const AlongRange& region, const PoseBelief& belief,
                                          const Pinhole& camera,
                                          const LandmarkMatchSettings& settings) {
  struct Claim {
    int squared = kFar;
    std::size_t landmark = 0;
  };
  std::vector<Claim> claims(frame.features.size());  // each feature goes to the most alike
  const int max_squared = squared_steps(settings.max_distance, codebook_step);
  const double max_ratio_squared = std::pow(settings.max_expected_ratio, 2);
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    const PlacedLandmark& landmark = landmarks[i];
    if (!mapped_in(landmark, region, settings.along_margin_m)) continue;
    const auto expected = expected_sight(landmark, belief, camera, settings);
    if (!expected) continue;
    int best = kFar;
    int second = kFar;
    std::size_t nearest = frame.features.size();
    frame.grid.visit_near(
        static_cast<float>(expected->pixel.x()), static_cast<float>(expected->pixel.y()),
        static_cast<float>(expected->radius_px), [&](std::size_t f) {
          const Feature& feature = frame.features[f];
          const Eigen::Vector2d off = Eigen::Vector2d(feature.x_px, feature.y_px) - expected->pixel;
          if (off.norm() > expected->radius_px) return;
          if (std::abs(std::log(feature.scale_px / expected->scale_px)) > settings.max_log_scale)
            return;
          const int squared = distance_squared(frame.descriptors[f], landmark.descriptor);
          const bool other_place = nearest == frame.features.size() ||
                                   std::hypot(feature.x_px - frame.features[nearest].x_px,
                                              feature.y_px - frame.features[nearest].y_px) > 2;
          if (squared < best) {
            if (nearest != frame.features.size() && other_place) second = best;
            best = squared;
            nearest = f;
          } else if (squared < second && other_place) {
            second = squared;
          }
        });
    if (best >= max_squared || best > max_ratio_squared * second) continue;
    if (best < claims[nearest].squared) claims[nearest] = {best, i};
  }
  std::vector<LandmarkMatch> matches;
  for (std::size_t f = 0; f < claims.size(); ++f) {
    if (claims[f].squared != kFar) matches.push_back({f, claims[f].landmark});
  }
  return matches;
}

}  // namespace milepost
