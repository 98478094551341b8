// Landmarks in front of a camera, and the observed features.
#pragma once

#include <random>
#include <vector>

#include "client/localize/landmark_window.h"
#include "client/localize/pose_belief.h"
#include "client/localize/pose_solver.h"
#include "schema/geo/geodesy.h"

namespace milepost::testing {

inline constexpr Pinhole kSceneCamera = {520, 500, 310, 190};

inline LocalLandmark landmark_at(const Eigen::Vector3d& enu_m, double size_m = 0.2) {
  LocalLandmark landmark;
  landmark.enu_m = enu_m;
  landmark.mapping_ray = enu_m.normalized();
  landmark.size_m = size_m;
  return landmark;
}

// Without noise. REQUIRES: the landmark lies in front of the camera.
inline Feature seen_feature(const LocalLandmark& landmark, const CameraPose& pose,
                            const Pinhole& camera = kSceneCamera) {
  const Eigen::Vector3d seen = point_in_camera(pose, landmark.enu_m);
  const Eigen::Vector2d pixel = camera.project(seen);
  return {static_cast<float>(pixel.x()), static_cast<float>(pixel.y()),
          static_cast<float>(landmark.size_m * camera.focal_px() / seen.z())};
}

struct LandmarkScene {
  CameraPose pose;
  std::vector<LocalLandmark> landmarks;
  std::vector<Feature> features;       // one per landmark
  std::vector<LandmarkMatch> matches;  // feature i is landmark i

  // A camera that looks to the north-east, and `count` landmarks 5 to 40 m in front of it.
  explicit LandmarkScene(std::size_t count, unsigned seed = 1) {
    pose.enu_m = {12, -7, 1.5};
    pose.heading_rad = 40 * kRadPerDeg;
    pose.pitch_rad = 2 * kRadPerDeg;
    pose.roll_rad = -1.5 * kRadPerDeg;
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> x(-0.6, 0.6);  // of the ray
    std::uniform_real_distribution<double> y(-0.35, 0.35);
    std::uniform_real_distribution<double> depth_m(5, 40);
    std::uniform_real_distribution<double> size_m(0.1, 0.5);
    for (std::size_t i = 0; i < count; ++i) {
      const double z = depth_m(random);
      const Eigen::Vector3d seen(x(random) * z, y(random) * z, z);
      landmarks.push_back(
          landmark_at(pose.enu_m + camera_from_enu(pose).transpose() * seen, size_m(random)));
      features.push_back(seen_feature(landmarks.back(), pose));
      matches.push_back({i, i});
    }
  }

  StateVector state() const {
    StateVector state = StateVector::Zero();
    state.head<3>() = pose.enu_m;
    state[kHeading] = pose.heading_rad;
    state[kPitch] = pose.pitch_rad;
    state[kRoll] = pose.roll_rad;
    state[kSpeed] = 10;
    return state;
  }

  // A belief around `mean` with `sigma_m` and `sigma_deg` per axis.
  static PoseBelief belief(const StateVector& mean, double sigma_m, double sigma_deg) {
    StateVector sigmas;
    const double sigma_rad = sigma_deg * kRadPerDeg;
    sigmas << sigma_m, sigma_m, sigma_m, sigma_rad, sigma_rad, sigma_rad, 1e-3, 1e-3, 1e-3, 1, 0.1,
        0.03, 0.01, 0.01;
    return {mean, sigmas.cwiseAbs2().asDiagonal()};
  }
};

inline double position_error_m(const PoseBelief& belief, const CameraPose& truth) {
  return (belief.pose().enu_m - truth.enu_m).norm();
}

inline double angle_error_deg(const PoseBelief& belief, const CameraPose& truth) {
  const CameraPose pose = belief.pose();
  return Eigen::Vector3d(pose.heading_rad - truth.heading_rad, pose.pitch_rad - truth.pitch_rad,
                         pose.roll_rad - truth.roll_rad)
             .norm() /
         kRadPerDeg;
}

}  // namespace milepost::testing
