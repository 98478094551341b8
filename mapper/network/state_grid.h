// Finds the states of ways near a position.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "mapper/network/way.h"

namespace milepost {

// A state by the indices of its way and in it; ordered by them.
struct StateIndex {
  std::uint32_t way = 0;
  std::uint32_t state = 0;

  friend bool operator<(const StateIndex& a, const StateIndex& b) {
    return a.way != b.way ? a.way < b.way : a.state < b.state;
  }
};

// A grid of geocentric cubes; memory is linear in the number of states. Immutable.
class StateGrid {
 public:
  // `ways` must outlive the grid.
  StateGrid(const std::vector<Way>& ways, double reach_m);

  // The states within the grid's reach of a position, ordered.
  std::vector<StateIndex> near(const Eigen::Vector3d& position_m) const;

 private:
  using Cell = std::uint64_t;
  Cell cell_at(const Eigen::Vector3d& position_m) const;

  const std::vector<Way>& ways_;
  double reach_m_;
  std::unordered_map<Cell, std::vector<StateIndex>> states_in_;
};

}  // namespace milepost
