// The walls around a vehicle in plan view with a spatial index for ray casting and crossing tests.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace milepost {

// A wall in a local tangent frame: east, north.
struct PlanWall {
  Eigen::Vector2d begin_m;
  Eigen::Vector2d end_m;
  double sigma_m = 0;  // standard deviation of a point's distance from the true wall

  double azimuth_rad() const;  // of the direction from begin to end, clockwise from north
};

struct PlanBox {
  Eigen::Vector2d min_m = Eigen::Vector2d::Zero();
  Eigen::Vector2d max_m = Eigen::Vector2d::Zero();

  bool contains(const Eigen::Vector2d& point_m) const {
    return (point_m.array() >= min_m.array()).all() && (point_m.array() <= max_m.array()).all();
  }
};

// Immutable, so safe to share between threads. A uniform grid of squares lists the walls that
// intersect each square; rays traverse it square by square.
class RayCastingGrid {
 public:
  // Walls without length are omitted. REQUIRES: all coordinates are finite.
  explicit RayCastingGrid(std::vector<PlanWall> walls);

  struct Hit {
    double range_m = 0;
    std::uint32_t wall = 0;  // index into walls()
  };

  // The first wall hit by a ray from a point in the direction of a unit vector, within `reach_m`.
  std::optional<Hit> first_hit(const Eigen::Vector2d& from_m, const Eigen::Vector2d& direction,
                               double reach_m) const;

  // Whether the straight line between two points crosses a wall.
  bool is_crossed(const Eigen::Vector2d& from_m, const Eigen::Vector2d& to_m) const;

  const std::vector<PlanWall>& walls() const { return walls_; }
  const PlanBox& bounds() const { return bounds_; }  // of all walls; the point (0, 0) without any

 private:
  std::size_t square_of(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }

  std::vector<PlanWall> walls_;
  PlanBox bounds_;
  int columns_ = 0;
  int rows_ = 0;
  // The walls of square i are wall_of_square_[first_of_square_[i]] up to first_of_square_[i + 1].
  std::vector<std::uint32_t> first_of_square_;
  std::vector<std::uint32_t> wall_of_square_;
};

}  // namespace milepost
