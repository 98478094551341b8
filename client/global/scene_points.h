// Triangulation of scene points from a moving camera with odometry, without a map.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "client/global/camera_motion.h"
#include "schema/geo/camera.h"

namespace milepost {

// A point in the camera frame: x to the right, y down, z forward, metres.
struct ScenePoint {
  Eigen::Vector3d camera_m;
  double range_sigma_m = 0;  // standard deviation along the ray
};

struct ScenePointSettings {
  int features = 1200;          // ORB features of a frame
  double pixel_sigma_px = 1;    // of a feature's position
  double min_step_m = 0.4;      // minimum motion since the last frame used ...
  double min_step_rad = 0.03;   // ... or this rotation
  double max_sigma_part = 0.2;  // of a point's range; less certain points are omitted
};

// Tracks features by their descriptors along epipolar lines and triangulates each from all frames
// that observed it. Not safe to use from several threads at once.
class ScenePointTracker {
 public:
  ScenePointTracker(const Camera& camera, const ScenePointSettings& settings);

  // The points observed in the frame; none if it is too near to the last frame used. `motion` is
  // the odometry since the last call. REQUIRES: `gray` is CV_8UC1 and not empty.
  std::vector<ScenePoint> observe(const cv::Mat& gray, const OdometryIncrement& motion);

 private:
  using Descriptor = std::array<std::uint64_t, 4>;
  struct Feature {
    Eigen::Vector3d ray;  // z = 1
    Descriptor descriptor{};
  };
  // The origin and direction of a ray in the frame of the first camera.
  struct RayObservation {
    Eigen::Vector3d from_m;
    Eigen::Vector3d direction;  // unit
  };
  struct Track {
    Feature last;
    std::vector<RayObservation> observations;
  };
  struct Match {
    std::size_t track = 0;
    std::size_t feature = 0;
  };

  std::vector<Feature> features_of(const cv::Mat& gray) const;
  std::vector<Match> matches_of(const std::vector<Feature>& features,
                                const Eigen::Isometry3d& before_from_now) const;
  void follow(const std::vector<Feature>& features, const Eigen::Isometry3d& by_odometry);
  std::vector<ScenePoint> triangulated() const;

  Camera camera_;
  ScenePointSettings settings_;
  OdometryIncrement since_last_;  // frame that was used
  Eigen::Isometry3d first_from_camera_ = Eigen::Isometry3d::Identity();
  std::vector<Track> tracks_;  // of the last frame's features
};

}  // namespace milepost
