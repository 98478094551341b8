// Sunlight and sky visibility of the points of a scene.
#pragma once

#include <cstdint>
#include <vector>

#include "tests/simulator/light.h"
#include "tests/simulator/projection.h"
#include "tests/simulator/scene.h"

namespace milepost::simulator {

// A shadow map: the scene's depth from the sun. Immutable, so safe to share between threads.
class ShadowMap {
 public:
  ShadowMap(const Scene& scene, const Point& to_sun);

  // The share of sunlight, [0, 1], that reaches a point of a surface with the given normal.
  float sunlight(const Point& point, const Point& normal) const;

 private:
  Projection from_sun_;
  std::vector<float> nearness_;
};

// A height map, from which the share of visible sky is computed. Immutable, so safe to share
// between threads.
class SkyView {
 public:
  // `height_m` holds a height above the ground every kCellM, its rows northwards from `south_west`.
  SkyView(const cv::Mat& height_m, const cv::Vec2d& south_west);

  static constexpr double kCellM = 1;

  // The visible share of the sky, [0, 1], weighted by the cosine to the zenith, at a height above
  // the ground; 1 outside of the town.
  float open_share(const cv::Vec2d& position, double above_ground_m) const;

 private:
  cv::Mat share_;  // at the ground
  cv::Vec2d south_west_;
};

}  // namespace milepost::simulator
