// A synthetic street of points and a camera that drives along it, with ground truth.
#pragma once

#include <random>
#include <vector>

#include "mapper/landmarks/feature_track.h"
#include "schema/drive/drive.h"
#include "schema/tile/observation.h"

namespace milepost::testing {

inline constexpr Camera kStreetCamera{600, 500, {360, 400, 300, 250}};
inline constexpr Pinhole kStreetPinhole{360, 400, 300, 250};
inline constexpr double kFrameSpacingM = 1.97;  // not a multiple of a tile's steps

struct StreetPoint {
  Eigen::Vector3d enu_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d step_m = Eigen::Vector3d::Zero();  // from frame to frame, of a moving point
  double size_m = 0;                                 // s * depth / f of its feature
};

struct StreetPlan {
  std::size_t frames = 40;
  std::size_t points = 300;
  double heading_deg = 30;       // of the first frame
  double turn_deg = 0.4;         // from frame to frame
  double mounting_deg = 0;       // of the camera's yaw against the recorded headings
  double heading_noise_deg = 0;  // of a recorded heading; standard deviations, like all below
  double position_noise_m = 0;   // of a recorded position
  double altitude_noise_m = 0;   // of a recorded altitude
  double tilt_deg = 0;           // of pitch and of roll
  double pixel_noise_px = 0;
  double nearest_m = 5;    // depth from which a point is seen ...
  double farthest_m = 50;  // ... to which
  unsigned seed = 1;
};

// Deterministic: the same plan gives the same street.
class MadeUpStreet {
 public:
  explicit MadeUpStreet(const StreetPlan& plan);

  std::vector<CameraPose> poses;     // true
  std::vector<CameraPose> recorded;  // pitch and roll 0
  std::vector<StreetPoint> points;

  // The camera's observations of a point, with pixel noise, in each frame from the first to the
  // last in which it is visible. Empty if it is visible in fewer than three.
  FeatureTrack observations_of(const StreetPoint& point);
  std::vector<FeatureTrack> sights_of_all();
  // The same as input of the mapper: `along_m` of frame i is i * kFrameSpacingM, and the i-th
  // point has the descriptor `descriptor_of(i)`.
  Track track_of(std::size_t point);
  Frame frame(std::size_t i) const;

  static GeoPoint geo_of(const Eigen::Vector3d& enu_m);
  static Eigen::Vector3d enu_of(const GeoPoint& position);

 private:
  StreetPlan plan_;
  std::mt19937 random_;
};

// A distinct one for each number.
Descriptor descriptor_of(std::size_t number);

}  // namespace milepost::testing
