#include "mapper/network/state_grid.h"

#include <algorithm>
#include <cmath>

namespace milepost {

StateGrid::StateGrid(const std::vector<Way>& ways, double reach_m)
    : ways_(ways), reach_m_(reach_m) {
  for (std::size_t way = 0; way < ways.size(); ++way) {
    for (std::size_t state = 0; state < ways[way].states.size(); ++state) {
      states_in_[cell_at(ways[way].states[state].position_m)].push_back(
          {static_cast<std::uint32_t>(way), static_cast<std::uint32_t>(state)});
    }
  }
}

// 21 bits an axis: unique for cubes of 8 m and more on the whole earth.
StateGrid::Cell StateGrid::cell_at(const Eigen::Vector3d& position_m) const {
  const auto index = [this](double metres) {
    return static_cast<Cell>(std::floor(metres / reach_m_) + (1 << 20));
  };
  return index(position_m.x()) << 42 | index(position_m.y()) << 21 | index(position_m.z());
}

std::vector<StateIndex> StateGrid::near(const Eigen::Vector3d& position_m) const {
  std::vector<StateIndex> found;
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) {
        const auto cell =
            states_in_.find(cell_at(position_m + reach_m_ * Eigen::Vector3d(x, y, z)));
        if (cell == states_in_.end()) continue;
        for (const StateIndex& index : cell->second) {
          const RoadState& state = ways_[index.way].states[index.state];
          if ((state.position_m - position_m).norm() <= reach_m_) found.push_back(index);
        }
      }
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace milepost
