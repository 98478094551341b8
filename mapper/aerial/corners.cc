#include "mapper/aerial/corners.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <vector>

#include "mapper/aerial/line_grid.h"
#include "schema/geo/geodesy.h"

namespace milepost {
namespace {

struct LineEnd {
  std::size_t line = 0;
  bool is_begin = false;

  const Eigen::Vector2d& at(const WallLines& lines) const {
    return is_begin ? lines[line].begin_m : lines[line].end_m;
  }
  void move(WallLines& lines, const Eigen::Vector2d& to_m) const {
    (is_begin ? lines[line].begin_m : lines[line].end_m) = to_m;
  }
  std::size_t number() const { return 2 * line + (is_begin ? 0 : 1); }
};

struct Corner {
  double move_m = 0;  // the larger displacement of the two ends
  LineEnd a, b;
  Eigen::Vector2d at_m;

  auto order() const { return std::tuple(move_m, a.number(), b.number()); }
};

// The intersection of the straight lines through both, if their angle is large enough.
std::optional<Eigen::Vector2d> crossing(const WallLine& a, const WallLine& b,
                                        double min_angle_deg) {
  const Eigen::Vector2d along_a = direction_of(a);
  const Eigen::Vector2d along_b = direction_of(b);
  const double sine = along_a.dot(right_of(along_b));
  if (std::abs(sine) < std::sin(min_angle_deg * kRadPerDeg)) return std::nullopt;
  return a.begin_m + (b.begin_m - a.begin_m).dot(right_of(along_b)) / sine * along_a;
}

// An end moves at most to the middle of its line, so that no line is reversed.
bool may_move(const WallLines& lines, const LineEnd& end, double move_m) {
  return move_m < lines[end.line].length_m() / 2;
}

std::vector<Corner> corners_of(const WallLines& lines, const CornerSettings& settings) {
  LineGrid grid(2 * settings.reach_m);
  for (std::size_t i = 0; i < lines.size(); ++i) grid.add(i, lines[i]);
  std::vector<Corner> corners;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    for (const std::size_t j : grid.near(lines[i])) {
      if (j <= i) continue;
      const auto at_m = crossing(lines[i], lines[j], settings.min_angle_deg);
      if (!at_m) continue;
      for (const LineEnd& a : {LineEnd{i, true}, LineEnd{i, false}}) {
        for (const LineEnd& b : {LineEnd{j, true}, LineEnd{j, false}}) {
          const double move_a_m = (a.at(lines) - *at_m).norm();
          const double move_b_m = (b.at(lines) - *at_m).norm();
          if (std::max(move_a_m, move_b_m) > settings.reach_m) continue;
          if (!may_move(lines, a, move_a_m) || !may_move(lines, b, move_b_m)) continue;
          corners.push_back({std::max(move_a_m, move_b_m), a, b, *at_m});
        }
      }
    }
  }
  std::sort(corners.begin(), corners.end(),
            [](const Corner& a, const Corner& b) { return a.order() < b.order(); });
  return corners;
}

}  // namespace

WallLines with_corners(WallLines lines, const CornerSettings& settings) {
  std::vector<bool> is_settled(2 * lines.size(), false);
  for (const Corner& corner : corners_of(lines, settings)) {
    if (is_settled[corner.a.number()] || is_settled[corner.b.number()]) continue;
    corner.a.move(lines, corner.at_m);
    corner.b.move(lines, corner.at_m);
    is_settled[corner.a.number()] = is_settled[corner.b.number()] = true;
  }
  return lines;
}

}  // namespace milepost
