#include "client/global/ray_casting_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace milepost {
namespace {

constexpr double kSquareM = 4;
constexpr double kRounding = 1e-9;
constexpr double kNever = std::numeric_limits<double>::infinity();

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

// The ray parameter, in lengths of `direction`, at which the ray meets the wall; kNever if it does
// not.
double meeting(const Eigen::Vector2d& from_m, const Eigen::Vector2d& direction,
               const PlanWall& wall) {
  const Eigen::Vector2d way = wall.end_m - wall.begin_m;
  const double determinant = cross(direction, way);
  if (determinant == 0) return kNever;
  const Eigen::Vector2d to_begin = wall.begin_m - from_m;
  const double on_wall = cross(to_begin, direction) / determinant;
  if (on_wall < 0 || on_wall > 1) return kNever;
  const double on_ray = cross(to_begin, way) / determinant;
  return on_ray >= 0 ? on_ray : kNever;
}

// Grid traversal of a ray (Amanatides and Woo, 1987): for each axis the ray parameter at which the
// next square is entered.
class GridTraversal {
 public:
  GridTraversal(const Eigen::Vector2d& from_squares, const Eigen::Vector2d& way_squares)
      : column(static_cast<int>(std::floor(from_squares.x()))),
        row(static_cast<int>(std::floor(from_squares.y()))) {
    for (int axis = 0; axis < 2; ++axis) {
      const double way = way_squares[axis];
      const double from = from_squares[axis];
      step_[axis] = way > 0 ? 1 : -1;
      each_[axis] = way == 0 ? kNever : 1 / std::abs(way);
      const double to_border = way > 0 ? std::floor(from) + 1 - from : from - std::floor(from);
      next_[axis] = way == 0 ? kNever : to_border * each_[axis];
    }
  }

  // The ray parameter in [0, 1] at which the current square is left.
  double leaves_at() const { return std::min(next_[0], next_[1]); }

  void go_on() {
    const int axis = next_[0] < next_[1] ? 0 : 1;
    next_[axis] += each_[axis];
    (axis == 0 ? column : row) += step_[axis];
  }

  int column;
  int row;

 private:
  int step_[2] = {0, 0};
  double each_[2] = {0, 0};
  double next_[2] = {0, 0};
};

// The part of a ray, from 0 to 1 of its length, inside the box; none if there is none.
struct Part {
  double from = 0;
  double to = 0;
};

std::optional<Part> part_inside(const PlanBox& box, const Eigen::Vector2d& from_m,
                                const Eigen::Vector2d& distance_m) {
  Part part{0, 1};
  for (int axis = 0; axis < 2; ++axis) {
    if (distance_m[axis] == 0) {
      if (from_m[axis] < box.min_m[axis] || from_m[axis] > box.max_m[axis]) return std::nullopt;
      continue;
    }
    double enters = (box.min_m[axis] - from_m[axis]) / distance_m[axis];
    double leaves = (box.max_m[axis] - from_m[axis]) / distance_m[axis];
    if (enters > leaves) std::swap(enters, leaves);
    part = {std::max(part.from, enters), std::min(part.to, leaves)};
  }
  if (part.from > part.to) return std::nullopt;
  return part;
}

PlanBox box_around(const std::vector<PlanWall>& walls) {
  if (walls.empty()) return {};
  PlanBox box{walls.front().begin_m, walls.front().begin_m};
  for (const PlanWall& wall : walls) {
    box.min_m = box.min_m.cwiseMin(wall.begin_m).cwiseMin(wall.end_m);
    box.max_m = box.max_m.cwiseMax(wall.begin_m).cwiseMax(wall.end_m);
  }
  return box;
}

}  // namespace

double PlanWall::azimuth_rad() const {
  const Eigen::Vector2d way = end_m - begin_m;
  return std::atan2(way.x(), way.y());
}

RayCastingGrid::RayCastingGrid(std::vector<PlanWall> walls) : walls_(std::move(walls)) {
  std::erase_if(walls_, [](const PlanWall& wall) { return wall.begin_m == wall.end_m; });
  bounds_ = box_around(walls_);
  const Eigen::Vector2d size_squares = (bounds_.max_m - bounds_.min_m) / kSquareM;
  columns_ = static_cast<int>(std::floor(size_squares.x())) + 1;
  rows_ = static_cast<int>(std::floor(size_squares.y())) + 1;

  std::vector<std::vector<std::uint32_t>> squares(square_of(0, rows_));
  for (std::uint32_t i = 0; i < walls_.size(); ++i) {
    const Eigen::Vector2d from = (walls_[i].begin_m - bounds_.min_m) / kSquareM;
    const Eigen::Vector2d way = (walls_[i].end_m - walls_[i].begin_m) / kSquareM;
    GridTraversal walk(from, way);
    while (true) {
      const bool inside =
          walk.column >= 0 && walk.column < columns_ && walk.row >= 0 && walk.row < rows_;
      if (inside) squares[square_of(walk.column, walk.row)].push_back(i);
      if (walk.leaves_at() > 1) break;
      walk.go_on();
    }
  }
  first_of_square_.push_back(0);
  for (const auto& square : squares) {
    wall_of_square_.insert(wall_of_square_.end(), square.begin(), square.end());
    first_of_square_.push_back(static_cast<std::uint32_t>(wall_of_square_.size()));
  }
}

std::optional<RayCastingGrid::Hit> RayCastingGrid::first_hit(const Eigen::Vector2d& from_m,
                                                             const Eigen::Vector2d& direction,
                                                             double reach_m) const {
  const Eigen::Vector2d distance_m = direction * reach_m;
  const std::optional<Part> inside = part_inside(bounds_, from_m, distance_m);
  if (!inside) return std::nullopt;
  const Eigen::Vector2d entry_m = from_m + distance_m * inside->from;
  GridTraversal walk((entry_m - bounds_.min_m) / kSquareM, distance_m / kSquareM);
  walk.column = std::clamp(walk.column, 0, columns_ - 1);
  walk.row = std::clamp(walk.row, 0, rows_ - 1);
  while (walk.column >= 0 && walk.column < columns_ && walk.row >= 0 && walk.row < rows_) {
    const std::size_t square = square_of(walk.column, walk.row);
    double nearest = kNever;
    std::uint32_t nearest_wall = 0;
    for (std::uint32_t i = first_of_square_[square]; i < first_of_square_[square + 1]; ++i) {
      const double at = meeting(from_m, distance_m, walls_[wall_of_square_[i]]);
      if (at < nearest) {
        nearest = at;
        nearest_wall = wall_of_square_[i];
      }
    }
    // A wall that is hit beyond this square is reported in the square of the hit.
    const double leaves_at = inside->from + walk.leaves_at();
    if (nearest <= std::min(leaves_at + kRounding, 1.0))
      return Hit{nearest * reach_m, nearest_wall};
    if (leaves_at > 1) return std::nullopt;
    walk.go_on();
  }
  return std::nullopt;
}

bool RayCastingGrid::is_crossed(const Eigen::Vector2d& from_m, const Eigen::Vector2d& to_m) const {
  const Eigen::Vector2d distance_m = to_m - from_m;
  const double length_m = distance_m.norm();
  return length_m > 0 && first_hit(from_m, distance_m / length_m, length_m).has_value();
}

}  // namespace milepost
