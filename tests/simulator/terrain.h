// The terrain: gentle swells and one hill.
#pragma once

#include <opencv2/core.hpp>

namespace milepost::simulator {

struct Terrain {
  cv::Vec2d hill_top{-178, 195};  // east, north
  double hill_height_m = 13;
  double hill_reach_m = 72;  // standard deviation of its bell shape
  double swell_m = 0.35;     // amplitude of the swells
  double swell_phase = 0;

  double height_m(const cv::Vec2d& position) const;
};

}  // namespace milepost::simulator
