#include "tests/simulator/terrain.h"

#include <cmath>

namespace milepost::simulator {

double Terrain::height_m(const cv::Vec2d& position) const {
  const double distance = cv::norm(position - hill_top) / hill_reach_m;
  const double swell = std::sin(position[0] / 37 + swell_phase) + std::sin(position[1] / 53);
  return hill_height_m * std::exp(-distance * distance / 2) + swell_m * swell;
}

}  // namespace milepost::simulator
