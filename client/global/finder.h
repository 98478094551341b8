// Finds a vehicle among the walls of an area, from frames and wheels alone: no receiver, no idea
// where it is. The aerial paper, sections III and IV.
#pragma once

#include <memory>
#include <optional>
#include <span>

#include <opencv2/core.hpp>

#include "client/global/wall_filter.h"
#include "client/global/wall_observer.h"
#include "client/global/wheel_log.h"
#include "schema/geo/geodesy.h"
#include "schema/geo/pinhole.h"
#include "schema/tile/wall.h"

namespace milepost {

// Where a vehicle is known to be at first.
struct FindStart {
  GeoPoint position;                  // the altitude plays no part
  double sigma_m = 0;                 // in each direction, above 0
  std::optional<double> heading_deg;  // none: it may look anywhere
  double heading_sigma_deg = 10;
};

struct FinderSettings {
  FindMethod method = combined_method();
  std::size_t particles = 2000;
  std::uint64_t seed = 1;
  std::optional<FindStart> start;  // none: anywhere in the area
  // Where the vehicle may be; none: within area_margin_m of the box around the walls and a known
  // start. Walls outside of it are seen from within.
  std::optional<Bounds> area;
  double area_margin_m = 10;
};

// The answer for one frame.
struct FindFix {
  double timestamp_s = 0;
  FindStatus status = FindStatus::initializing;
  GeoPoint position;       // of the camera, where the belief is densest; altitude 0
  double heading_deg = 0;  // of the camera, clockwise from north, [0, 360)
  // One standard deviation in each direction: while nothing is found, of the whole belief.
  double sigma_m = 0;
  double heading_sigma_deg = 0;
  double mass = 0;       // part of the belief that lies there
  double explained = 0;  // share of what was seen lately that the walls there explain
};

// Not safe to use from several threads at once. The same walls, frames, readings and settings give
// the same fixes.
class Finder {
 public:
  // REQUIRES: there are walls, none of which crosses longitude 180; particles > 0.
  Finder(std::span<const Wall> walls, const Pinhole& view, const FinderSettings& settings);
  ~Finder();
  Finder(Finder&&) noexcept;
  Finder& operator=(Finder&&) noexcept;

  // Readings of the wheels up to a frame are told before it.
  void observe(const Odometry& reading);

  // The fix of the next frame. REQUIRES: timestamps ascend strictly; `gray` is CV_8UC1, not empty.
  FindFix find(const cv::Mat& gray, double timestamp_s);

  // For those who look on: the belief after the latest frame, in the tangent frame at origin().
  const ParticleCloud& particles() const;
  const WallIndex& walls() const;
  const GeoPoint& origin() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace milepost
