#include "client/global/scene_points.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

#include <opencv2/features2d.hpp>

namespace milepost {
namespace {

constexpr std::size_t kMaxSights = 10;
constexpr double kNearestM = 2;    // nothing that is followed is nearer
constexpr double kSearchPx = 8;    // from the line of a match, before the motion is refined
constexpr double kAgreesPx = 2.5;  // after it
constexpr int kMaxBits = 60;       // of 256 that differ between descriptors of a match
constexpr double kBestToSecond = 0.85;

int bits_between(const std::array<std::uint64_t, 4>& a, const std::array<std::uint64_t, 4>& b) {
  int bits = 0;
  for (std::size_t i = 0; i < a.size(); ++i) bits += std::popcount(a[i] ^ b[i]);
  return bits;
}

Eigen::Vector2d on_plane(const Eigen::Vector3d& camera) { return camera.head<2>() / camera.z(); }

// Where a ray of the frame before can be now: between its point at infinity and a near one.
struct SearchLine {
  Eigen::Vector2d from;
  Eigen::Vector2d way;

  static std::optional<SearchLine> of(const Eigen::Vector3d& ray, const CameraMotion& motion) {
    const Eigen::Vector3d far = motion.now_from_before * ray;
    Eigen::Vector3d near = motion.now_from_before * (kNearestM * ray - motion.way_m);
    if (far.z() <= 0.1) return std::nullopt;
    // A point behind the camera's plane: the line goes off the image.
    if (near.z() <= 0.1)
      near = motion.now_from_before * ((motion.way_m.z() + 0.5) * ray - motion.way_m);
    if (near.z() <= 0.1) return std::nullopt;
    return SearchLine{on_plane(far), on_plane(near) - on_plane(far)};
  }

  double squared_distance(const Eigen::Vector2d& point) const {
    const double length2 = way.squaredNorm();
    const double part = length2 > 0 ? std::clamp((point - from).dot(way) / length2, 0.0, 1.0) : 0;
    return (point - from - part * way).squaredNorm();
  }
};

// The point nearest to all sights, and the inverse of its covariance for sights of 1 rad noise.
struct Triangulation {
  Eigen::Vector3d point_m;
  Eigen::Matrix3d information;
};

template <class Sights>
std::optional<Triangulation> triangulate(const Sights& sights) {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  for (int iteration = 0; iteration < 3; ++iteration) {
    information.setZero();
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const auto& sight : sights) {
      const double range_m = iteration == 0 ? 10 : (point - sight.from_m).norm();
      const Eigen::Matrix3d across =
          (Eigen::Matrix3d::Identity() - sight.direction * sight.direction.transpose()) /
          (range_m * range_m);
      information += across;
      sum += across * sight.from_m;
    }
    const Eigen::LDLT<Eigen::Matrix3d> solver(information);
    if (solver.info() != Eigen::Success || solver.vectorD().minCoeff() < 1e-12) return std::nullopt;
    point = solver.solve(sum);
  }
  return Triangulation{point, information};
}

}  // namespace

ScenePointTracker::ScenePointTracker(const Pinhole& view, const ScenePointSettings& settings)
    : view_(view), settings_(settings) {}

std::vector<ScenePoint> ScenePointTracker::observe(const cv::Mat& gray, const WheelMotion& motion) {
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
  std::vector<Feature> features(keypoints.size());
  for (std::size_t i = 0; i < keypoints.size(); ++i) {
    features[i].ray = view_.ray_of(keypoints[i].pt.x, keypoints[i].pt.y);
    std::memcpy(features[i].descriptor.data(), descriptors.ptr(static_cast<int>(i)), 32);
  }
  return features;
}

std::vector<ScenePointTracker::Match> ScenePointTracker::matches_of(
    const std::vector<Feature>& features, const CameraMotion& motion) const {
  const double reach = kSearchPx / view_.focal_px();
  const double reach2 = reach * reach;
  struct Best {
    int bits = std::numeric_limits<int>::max();
    int second = std::numeric_limits<int>::max();
    std::size_t other = 0;
  };
  std::vector<Best> of_feature(features.size());
  std::vector<Best> of_track(tracks_.size());
  for (std::size_t t = 0; t < tracks_.size(); ++t) {
    const auto line = SearchLine::of(tracks_[t].last.ray, motion);
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

void ScenePointTracker::follow(const std::vector<Feature>& features, const CameraMotion& wheels) {
  const std::vector<Match> matches = matches_of(features, wheels);
  std::vector<RayPair> pairs;
  pairs.reserve(matches.size());
  for (const Match& match : matches) {
    pairs.push_back({tracks_[match.track].last.ray, features[match.feature].ray});
  }
  const double ray_sigma = settings_.pixel_sigma_px / view_.focal_px();
  const CameraMotion motion = refined_motion(pairs, wheels, ray_sigma);
  camera_m_ += first_from_camera_ * motion.way_m;
  first_from_camera_ = first_from_camera_ * motion.now_from_before.transpose();

  std::vector<Track> followed(features.size());
  for (std::size_t i = 0; i < matches.size(); ++i) {
    const double off_px = std::abs(epipolar_distance(pairs[i], motion)) * view_.focal_px();
    if (off_px > kAgreesPx) continue;
    followed[matches[i].feature].sights = std::move(tracks_[matches[i].track].sights);
  }
  for (std::size_t f = 0; f < features.size(); ++f) {
    Track& track = followed[f];
    track.last = features[f];
    track.sights.push_back({camera_m_, (first_from_camera_ * features[f].ray).normalized()});
    if (track.sights.size() > kMaxSights) track.sights.erase(track.sights.begin());
  }
  tracks_ = std::move(followed);
}

std::vector<ScenePoint> ScenePointTracker::triangulated() const {
  const double ray_sigma = settings_.pixel_sigma_px / view_.focal_px();
  std::vector<ScenePoint> points;
  for (const Track& track : tracks_) {
    if (track.sights.size() < 2) continue;
    const auto found = triangulate(track.sights);
    if (!found) continue;
    const Eigen::Vector3d camera_m = first_from_camera_.transpose() * (found->point_m - camera_m_);
    if (camera_m.z() <= kNearestM / 2) continue;
    const bool agrees = std::ranges::all_of(track.sights, [&](const Sight& sight) {
      const Eigen::Vector3d way = found->point_m - sight.from_m;
      return way.dot(sight.direction) > 0 &&
             way.cross(sight.direction).norm() < 3 * ray_sigma * way.norm();
    });
    if (!agrees) continue;
    const Eigen::Vector3d ray = (found->point_m - camera_m_).normalized();
    const double sigma_m = ray_sigma * std::sqrt(ray.dot(found->information.ldlt().solve(ray)));
    if (sigma_m > settings_.max_sigma_part * camera_m.norm()) continue;
    points.push_back({camera_m, sigma_m});
  }
  return points;
}

}  // namespace milepost
