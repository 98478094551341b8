// A street of points and a camera that drives along it, with all that is true of them.
#pragma once

#include <random>
#include <vector>

#include "mapper/landmarks/pixel_track.h"
#include "schema/drive/drive.h"
#include "schema/tile/observation.h"

namespace milepost::testing {

inline constexpr Camera kStreetCamera{600, 500, {360, 400, 300, 250}};
inline constexpr Pinhole kStreetPinhole{360, 400, 300, 250};
inline constexpr double kFrameSpacingM = 1.97;  // no whole number of a tile's steps

struct StreetPoint {
  Eigen::Vector3d enu_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d step_m = Eigen::Vector3d::Zero();  // from frame to frame, of what moves
  double size_m = 0;                                 // s * depth / f of its feature
};

struct StreetPlan {
  std::size_t frames = 40;
  std::size_t points = 300;
  double heading_deg = 30;       // of the first frame
  double turn_deg = 0.4;         // from frame to frame
  double mounting_deg = 0;       // of the camera's yaw against the recorded headings
  double heading_noise_deg = 0;  // of a recorded heading; standard deviations, as all below
  double position_noise_m = 0;   // of a recorded position
  double tilt_deg = 0;           // of pitch and of roll
  double pixel_noise_px = 0;
  double nearest_m = 5;    // depth from which a point is seen ...
  double farthest_m = 50;  // ... to which
  unsigned seed = 1;
};

// The same plan gives the same street.
class MadeUpStreet {
 public:
  explicit MadeUpStreet(const StreetPlan& plan);

  std::vector<CameraPose> poses;     // true
  std::vector<CameraPose> recorded;  // pitch and roll 0
  std::vector<StreetPoint> points;

  // What the camera records of a point, with noise of pixels: in each frame from the first to the
  // last that sees it. Empty where fewer than three do.
  PixelTrack sights_of(const StreetPoint& point);
  std::vector<PixelTrack> sights_of_all();
  // The same as the mapper gets it: `along_m` of frame i is i * kFrameSpacingM, and descriptors
  // are those of `descriptor_of(i)` for the i-th point.
  Track track_of(std::size_t point);
  Frame frame(std::size_t i) const;

  static GeoPoint geo_of(const Eigen::Vector3d& enu_m);
  static Eigen::Vector3d enu_of(const GeoPoint& position);

 private:
  StreetPlan plan_;
  std::mt19937 random_;
};

// One of its own for each number.
Descriptor descriptor_of(std::size_t number);

}  // namespace milepost::testing
