#include "tests/simulator/terrain.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace milepost::simulator {

double Cutting::depth_m_at(const cv::Vec2d& position) const {
  const cv::Vec2d off = position - centre;
  const double down = std::clamp((std::abs(off[0]) - half_level_m) / ramp_m, 0.0, 1.0);
  const double across = std::clamp((std::abs(off[1]) - half_floor_m) / slope_m, 0.0, 1.0);
  return depth_m * (1 - across) * (0.5 + 0.5 * std::cos(down * std::numbers::pi));
}

double Terrain::height_m(const cv::Vec2d& position) const {
  const double height = uncut_height_m(position);
  return cutting ? height - cutting->depth_m_at(position) : height;
}

double Terrain::uncut_height_m(const cv::Vec2d& position) const {
  const double distance = cv::norm(position - hill_top) / hill_reach_m;
  const double swell = std::sin(position[0] / 37 + swell_phase) + std::sin(position[1] / 53);
  return hill_height_m * std::exp(-distance * distance / 2) + swell_m * swell;
}

}  // namespace milepost::simulator
