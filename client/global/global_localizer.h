// Global localization of a vehicle among the walls of an area from frames and odometry alone,
// without GNSS (Monte Carlo localization). The aerial paper, sections III and IV.
#pragma once

#include <memory>
#include <optional>
#include <span>

#include <opencv2/core.hpp>

#include "client/global/odometry_buffer.h"
#include "client/global/wall_observer.h"
#include "client/global/wall_particle_filter.h"
#include "schema/geo/camera.h"
#include "schema/geo/geodesy.h"
#include "schema/tile/wall.h"

namespace milepost {

// Prior of the vehicle's initial pose.
struct PosePrior {
  GeoPoint position;                  // the altitude is ignored
  double sigma_m = 0;                 // standard deviation per axis, above 0
  std::optional<double> heading_deg;  // none: unknown
  double heading_sigma_deg = 10;
};

struct GlobalLocalizerSettings {
  GlobalMethod method = combined_method();
  std::size_t particles = 2000;
  std::uint64_t seed = 1;
  std::optional<PosePrior> start;  // none: anywhere in the area
  // The area that contains the vehicle; none: within area_margin_m of the box around the walls and
  // a known start. Walls outside of it are visible from within.
  std::optional<Bounds> area;
  double area_margin_m = 10;
};

// The pose estimate for one frame.
struct GlobalPoseEstimate {
  double timestamp_s = 0;
  GlobalStatus status = GlobalStatus::initializing;
  GeoPoint position;       // of the camera, at the densest mode; altitude 0
  double heading_deg = 0;  // of the camera, clockwise from north, [0, 360)
  // One standard deviation per axis; until converged, of all particles.
  double sigma_m = 0;
  double heading_sigma_deg = 0;
  double mode_probability = 0;  // probability of the mode, [0, 1]
  double inlier_ratio = 0;      // share of recent measurements explained at the mode, [0, 1]
};

// Not safe to use from several threads at once. The same walls, frames, readings and settings give
// the same estimates.
class GlobalLocalizer {
 public:
  // REQUIRES: there are walls, none of which crosses longitude 180; particles > 0.
  GlobalLocalizer(std::span<const Wall> walls, const Camera& camera,
                  const GlobalLocalizerSettings& settings);
  ~GlobalLocalizer();
  GlobalLocalizer(GlobalLocalizer&&) noexcept;
  GlobalLocalizer& operator=(GlobalLocalizer&&) noexcept;

  // Adds an odometry reading. Pass all readings up to a frame before that frame.
  void observe(const Odometry& reading);

  // The estimate for the next frame. REQUIRES: timestamps ascend strictly; `gray` is CV_8UC1, not
  // empty.
  GlobalPoseEstimate find(const cv::Mat& gray, double timestamp_s);

  // For reports: the belief after the latest frame, in the tangent frame at origin().
  const ParticleSet& particles() const;
  const RayCastingGrid& walls() const;
  const GeoPoint& origin() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace milepost
