// Walls in plan view for the tests of global localization.
#pragma once

#include <vector>

#include "client/global/ray_casting_grid.h"

namespace milepost::testing {

// The outline of a house.
inline void add_house(std::vector<PlanWall>& walls, const Eigen::Vector2d& south_west_m,
                      const Eigen::Vector2d& north_east_m) {
  const Eigen::Vector2d south_east_m(north_east_m.x(), south_west_m.y());
  const Eigen::Vector2d north_west_m(south_west_m.x(), north_east_m.y());
  walls.push_back({south_west_m, south_east_m, 0.1});
  walls.push_back({south_east_m, north_east_m, 0.1});
  walls.push_back({north_east_m, north_west_m, 0.1});
  walls.push_back({north_west_m, south_west_m, 0.1});
}

// A street 12 m wide that runs north for 100 m between long houses, and one to the east at its
// north end; a gap between the houses on its west.
inline std::vector<PlanWall> bent_street() {
  std::vector<PlanWall> walls;
  add_house(walls, {-26, 0}, {-6, 38});
  add_house(walls, {-24, 46}, {-6, 112});
  add_house(walls, {6, 0}, {24, 60});
  add_house(walls, {8, 63}, {30, 100});
  add_house(walls, {30, 96}, {90, 100});
  add_house(walls, {-24, 112}, {40, 130});
  add_house(walls, {44, 113}, {90, 132});
  add_house(walls, {94, 92}, {100, 120});
  return walls;
}

}  // namespace milepost::testing
