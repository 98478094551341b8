#include "client/global/scene_points.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

#include <opencv2/features2d.hpp>

#include "schema/geo/ray_triangulation.h"

namespace milepost {
namespace {

constexpr std::size_t kMaxSights = 10;
constexpr double kNearestM = 2;    // tracked points are assumed to be farther
constexpr double kSearchPx = 8;    // search distance from the epipolar line ...
constexpr double kAgreesPx = 2.5;  // ... and inlier distance, with the refined motion
constexpr int kMaxBits = 60;       // maximum Hamming distance of 256-bit descriptors
constexpr double kBestToSecond = 0.85;

int bits_between(const std::array<std::uint64_t, 4>& a, const std::array<std::uint64_t, 4>& b) {
  int bits = 0;
  for (std::size_t i = 0; i < a.size(); ++i) bits += std::popcount(a[i] ^ b[i]);
  return bits;
}

Eigen::Vector2d on_plane(const Eigen::Vector3d& camera) { return camera.head<2>() / camera.z(); }

// The part of the epipolar line on which a point of the previous frame can be now: between its
// point at infinity and a near one.
struct SearchLine {
  Eigen::Vector2d from;
  Eigen::Vector2d way;

  static std::optional<SearchLine> of(const Eigen::Vector3d& ray,
                                      const Eigen::Isometry3d& before_from_now) {
    const Eigen::Isometry3d now_from_before = before_from_now.inverse();
    const Eigen::Vector3d far = now_from_before.linear() * ray;
    Eigen::Vector3d near = now_from_before * (kNearestM * ray);
    if (far.z() <= 0.1) return std::nullopt;
    // A near point behind the camera's plane: the line leaves the image.
    if (near.z() <= 0.1) near = now_from_before * ((before_from_now.translation().z() + 0.5) * ray);
    if (near.z() <= 0.1) return std::nullopt;
    return SearchLine{on_plane(far), on_plane(near) - on_plane(far)};
  }

  double squared_distance(const Eigen::Vector2d& point) const {
    const double length2 = way.squaredNorm();
    const double part = length2 > 0 ? std::clamp((point - from).dot(way) / length2, 0.0, 1.0) : 0;
    return (point - from - part * way).squaredNorm();
  }
};

// The least squares intersection of the rays of all observations, each with an uncertainty of 1 rad
// in its direction.
template <class Sights>
std::optional<RayIntersection> meeting_point(const Sights& observations) {
  std::optional<RayIntersection> met;
  for (int iteration = 0; iteration < 3; ++iteration) {
    RayTriangulation rays;
    for (const auto& past : observations) {
      const double range_m = met ? (met->point_m - past.from_m).norm() : 10;
      rays.add(past.from_m, past.direction, 1 / (range_m * range_m));
    }
    met = rays.point();
    if (!met) break;
  }
  return met;
}

}  // namespace

ScenePointTracker::ScenePointTracker(const Camera& camera, const ScenePointSettings& settings)
    : camera_(camera), settings_(settings) {}

std::vector<ScenePoint> ScenePointTracker::observe(const cv::Mat& gray,
                                                   const OdometryIncrement& motion) {
  since_last_.duration_s += motion.duration_s;
  since_last_.distance_m += motion.distance_m;
  since_last_.turn_rad += motion.turn_rad;
  const bool moved = std::abs(since_last_.distance_m) >= settings_.min_step_m ||
                     std::abs(since_last_.turn_rad) >= settings_.min_step_rad;
  if (!moved && !tracks_.empty()) return {};
  follow(features_of(gray), camera_motion(since_last_));
  since_last_ = {};
  return triangulated();
}

std::vector<ScenePointTracker::Feature> ScenePointTracker::features_of(const cv::Mat& gray) const {
  const cv::Ptr<cv::ORB> orb =
      cv::ORB::create(settings_.features, 1.25F, 6, 15, 0, 2, cv::ORB::HARRIS_SCORE, 31, 12);
  std::vector<cv::KeyPoint> keypoints;
  cv::Mat descriptors;
  orb->detectAndCompute(gray, cv::noArray(), keypoints, descriptors);
  std::vector<Feature> features;
  features.reserve(keypoints.size());
  for (std::size_t i = 0; i < keypoints.size(); ++i) {
    const auto at = camera_.pinhole_from_image({keypoints[i].pt.x, keypoints[i].pt.y});
    if (!at) continue;
    Feature& feature = features.emplace_back();
    feature.ray = camera_.pinhole.unproject(at->pinhole_px.x(), at->pinhole_px.y());
    std::memcpy(feature.descriptor.data(), descriptors.ptr(static_cast<int>(i)), 32);
  }
  return features;
}

std::vector<ScenePointTracker::Match> ScenePointTracker::matches_of(
    const std::vector<Feature>& features, const Eigen::Isometry3d& before_from_now) const {
  const double reach = kSearchPx / camera_.pinhole.focal_px();
  const double reach2 = reach * reach;
  struct Best {
    int bits = std::numeric_limits<int>::max();
    int second = std::numeric_limits<int>::max();
    std::size_t other = 0;
  };
  std::vector<Best> of_feature(features.size());
  std::vector<Best> of_track(tracks_.size());
  for (std::size_t t = 0; t < tracks_.size(); ++t) {
    const auto line = SearchLine::of(tracks_[t].last.ray, before_from_now);
    if (!line) continue;
    const Eigen::Vector2d to = line->from + line->way;
    const Eigen::Vector2d low = line->from.cwiseMin(to).array() - reach;
    const Eigen::Vector2d high = line->from.cwiseMax(to).array() + reach;
    for (std::size_t f = 0; f < features.size(); ++f) {
      const Eigen::Vector2d at = features[f].ray.head<2>();
      if (at.x() < low.x() || at.x() > high.x() || at.y() < low.y() || at.y() > high.y()) continue;
      if (line->squared_distance(at) > reach2) continue;
      const int bits = bits_between(features[f].descriptor, tracks_[t].last.descriptor);
      if (bits < of_track[t].bits) {
        of_track[t] = {bits, of_track[t].bits, f};
      } else {
        of_track[t].second = std::min(of_track[t].second, bits);
      }
      if (bits < of_feature[f].bits) of_feature[f] = {bits, of_feature[f].bits, t};
    }
  }
  std::vector<Match> matches;
  for (std::size_t t = 0; t < tracks_.size(); ++t) {
    const Best& best = of_track[t];
    if (best.bits > kMaxBits || best.bits >= kBestToSecond * best.second) continue;
    if (of_feature[best.other].other == t) matches.push_back({t, best.other});
  }
  return matches;
}

void ScenePointTracker::follow(const std::vector<Feature>& features,
                               const Eigen::Isometry3d& by_odometry) {
  const std::vector<Match> matches = matches_of(features, by_odometry);
  std::vector<RayPair> pairs;
  pairs.reserve(matches.size());
  for (const Match& match : matches) {
    pairs.push_back({tracks_[match.track].last.ray, features[match.feature].ray});
  }
  const double ray_sigma = settings_.pixel_sigma_px / camera_.pinhole.focal_px();
  const Eigen::Isometry3d before_from_now = refined_motion(pairs, by_odometry, ray_sigma);
  first_from_camera_ = first_from_camera_ * before_from_now;

  std::vector<Track> continued(features.size());
  for (std::size_t i = 0; i < matches.size(); ++i) {
    const double off_px =
        std::abs(epipolar_distance(pairs[i], before_from_now)) * camera_.pinhole.focal_px();
    if (off_px > kAgreesPx) continue;
    continued[matches[i].feature].observations = std::move(tracks_[matches[i].track].observations);
  }
  for (std::size_t f = 0; f < features.size(); ++f) {
    Track& track = continued[f];
    track.last = features[f];
    track.observations.push_back({first_from_camera_.translation(),
                                  (first_from_camera_.linear() * features[f].ray).normalized()});
    if (track.observations.size() > kMaxSights)
      track.observations.erase(track.observations.begin());
  }
  tracks_ = std::move(continued);
}

std::vector<ScenePoint> ScenePointTracker::triangulated() const {
  const double ray_sigma = settings_.pixel_sigma_px / camera_.pinhole.focal_px();
  const Eigen::Isometry3d camera_from_first = first_from_camera_.inverse();
  std::vector<ScenePoint> points;
  for (const Track& track : tracks_) {
    if (track.observations.size() < 2) continue;
    const auto met = meeting_point(track.observations);
    if (!met) continue;
    const Eigen::Vector3d& point_m = met->point_m;
    const Eigen::Vector3d camera_m = camera_from_first * point_m;
    if (camera_m.z() <= kNearestM / 2) continue;
    const bool agrees = std::ranges::all_of(track.observations, [&](const RayObservation& past) {
      const Eigen::Vector3d way = point_m - past.from_m;
      return way.dot(past.direction) > 0 &&
             way.cross(past.direction).norm() < 3 * ray_sigma * way.norm();
    });
    if (!agrees) continue;
    const Eigen::Vector3d ray = (point_m - first_from_camera_.translation()).normalized();
    const double sigma_m = ray_sigma * std::sqrt(ray.dot(met->information.ldlt().solve(ray)));
    if (sigma_m > settings_.max_sigma_part * camera_m.norm()) continue;
    points.push_back({camera_m, sigma_m});
  }
  return points;
}

}  // namespace milepost
