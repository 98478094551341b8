// A piece of a building's outline in plan view, during extraction.
#pragma once

#include <vector>

#include <Eigen/Core>

namespace milepost {

// Between two points in metres east and north of a ground frame's origin. The interior of the
// building, if known, is on the right, looking from begin to end.
struct WallLine {
  Eigen::Vector2d begin_m;
  Eigen::Vector2d end_m;

  double length_m() const { return (end_m - begin_m).norm(); }
};

using WallLines = std::vector<WallLine>;

// The unit vector from begin to end. REQUIRES: the ends differ.
inline Eigen::Vector2d direction_of(const WallLine& line) {
  return (line.end_m - line.begin_m).normalized();
}

// Rotates by 90 degrees to the right.
inline Eigen::Vector2d right_of(const Eigen::Vector2d& direction) {
  return {direction.y(), -direction.x()};
}

}  // namespace milepost
