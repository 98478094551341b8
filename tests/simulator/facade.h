// Procedural fronts of houses, garden walls, poles and signs.
#pragma once

#include <algorithm>
#include <cmath>

#include <opencv2/core.hpp>

namespace milepost::simulator {

// Texels per metre of objects beside the road.
inline constexpr int kNearTexelsPerM = 60;
// The same for more distant surfaces: side and back walls.
inline constexpr int kFarTexelsPerM = 28;

struct WallSize {
  double width_m = 0;
  double height_m = 0;
  int texels_per_m = kNearTexelsPerM;

  cv::Size texels() const {
    return {std::max(1, static_cast<int>(std::lround(width_m * texels_per_m))),
            std::max(1, static_cast<int>(std::lround(height_m * texels_per_m)))};
  }
};

// Each paints a wall of the given size; `random` decides the style and every detail.
cv::Mat paint_facade(const WallSize& size, bool has_shops, cv::RNG& random);
cv::Mat paint_oriel(const WallSize& size, cv::RNG& random);  // upper floors only
cv::Mat paint_side_wall(const WallSize& size, cv::RNG& random);
cv::Mat paint_garden_wall(const WallSize& size, cv::RNG& random);
cv::Mat paint_traffic_sign(double side_m, cv::RNG& random);
cv::Mat paint_pole(const WallSize& size, cv::RNG& random);

}  // namespace milepost::simulator
