#include "mapper/aerial/closure.h"

#include <algorithm>
#include <vector>

#include "mapper/aerial/line_grid.h"

namespace milepost {
namespace {

bool ends_at(const WallLine& line, const Eigen::Vector2d& corner_m, double reach_m) {
  return (line.begin_m - corner_m).norm() <= reach_m || (line.end_m - corner_m).norm() <= reach_m;
}

}  // namespace

WallLines closed(WallLines lines, const ClosureSettings& settings) {
  LineGrid grid(settings.reach_m);
  for (std::size_t i = 0; i < lines.size(); ++i) grid.add(i, lines[i]);
  std::vector<bool> stands(lines.size(), true);
  const auto is_met = [&](std::size_t number, const Eigen::Vector2d& corner_m) {
    const std::vector<std::size_t> others = grid.near({corner_m, corner_m});
    return std::any_of(others.begin(), others.end(), [&](std::size_t other) {
      return other != number && stands[other] && ends_at(lines[other], corner_m, settings.reach_m);
    });
  };
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      if (!stands[i]) continue;
      const int met = (is_met(i, lines[i].begin_m) ? 1 : 0) + (is_met(i, lines[i].end_m) ? 1 : 0);
      if (met >= settings.min_ends) continue;
      stands[i] = false;
      changed = true;
    }
  }
  WallLines standing;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (stands[i]) standing.push_back(lines[i]);
  }
  return standing;
}

}  // namespace milepost
