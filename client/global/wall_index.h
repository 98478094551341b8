// The walls about a vehicle in plan view, found by place: what a ray meets, and what a step
// crosses.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace milepost {

// In a local tangent frame: east, north.
struct PlanWall {
  Eigen::Vector2d begin_m;
  Eigen::Vector2d end_m;
  double sigma_m = 0;  // of a point's distance from the true wall

  double azimuth_rad() const;  // of the way from begin to end
};

struct PlanBox {
  Eigen::Vector2d min_m = Eigen::Vector2d::Zero();
  Eigen::Vector2d max_m = Eigen::Vector2d::Zero();

  bool contains(const Eigen::Vector2d& point_m) const {
    return (point_m.array() >= min_m.array()).all() && (point_m.array() <= max_m.array()).all();
  }
};

// Immutable, so safe to share between threads. A uniform grid of squares lists the walls that pass
// through each; rays walk from square to square.
class WallIndex {
 public:
  // Walls without length are left out. REQUIRES: all coordinates are finite.
  explicit WallIndex(std::vector<PlanWall> walls);

  struct Hit {
    double range_m = 0;
    std::uint32_t wall = 0;  // index into walls()
  };

  // The first wall within `reach_m` from a point in the direction of a unit vector.
  std::optional<Hit> first_hit(const Eigen::Vector2d& from_m, const Eigen::Vector2d& direction,
                               double reach_m) const;

  // Whether the straight way from one point to another meets a wall.
  bool is_crossed(const Eigen::Vector2d& from_m, const Eigen::Vector2d& to_m) const;

  const std::vector<PlanWall>& walls() const { return walls_; }
  const PlanBox& bounds() const { return bounds_; }  // of all walls; a point at 0, 0 without any

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
