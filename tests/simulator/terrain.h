// The terrain: gentle swells, one hill and perhaps a cutting.
#pragma once

#include <optional>

#include <opencv2/core.hpp>

namespace milepost::simulator {

// A trench from west to east in which a road passes below another: level in the middle, with a ramp
// at either end and a slope at either side.
struct Cutting {
  cv::Vec2d centre;  // east, north
  double depth_m = 6;
  double half_level_m = 16;  // of the part of full depth, along the road
  double ramp_m = 90;
  double half_floor_m = 8;  // across
  double slope_m = 8;

  double depth_m_at(const cv::Vec2d& position) const;
};

struct Terrain {
  cv::Vec2d hill_top{-178, 195};  // east, north
  double hill_height_m = 13;
  double hill_reach_m = 72;  // standard deviation of its bell shape
  double swell_m = 0.35;     // amplitude of the swells
  double swell_phase = 0;

  std::optional<Cutting> cutting;

  double height_m(const cv::Vec2d& position) const;
  // Without the cutting: the height of a bridge across it.
  double uncut_height_m(const cv::Vec2d& position) const;
};

}  // namespace milepost::simulator
