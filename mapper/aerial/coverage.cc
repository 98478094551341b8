#include "mapper/aerial/coverage.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "mapper/aerial/line_grid.h"
#include "schema/geo/geodesy.h"

namespace milepost {
namespace {

constexpr double kStepM = 0.5;  // spacing of the sampled points of a line

double distance_m(const Eigen::Vector2d& point_m, const WallLine& line) {
  const Eigen::Vector2d along = direction_of(line);
  const double at_m = std::clamp(along.dot(point_m - line.begin_m), 0.0, line.length_m());
  return (point_m - line.begin_m - at_m * along).norm();
}

}  // namespace

WallLines not_covered(const WallLines& lines, const WallLines& known,
                      const CoverageSettings& settings) {
  LineGrid grid(std::max(1.0, settings.reach_m));
  for (std::size_t i = 0; i < known.size(); ++i) grid.add(i, known[i]);
  const double max_sine = std::sin(settings.max_angle_deg * kRadPerDeg);
  WallLines others;
  for (const WallLine& line : lines) {
    const Eigen::Vector2d across = right_of(direction_of(line));
    std::vector<std::size_t> beside = grid.near(line);
    std::erase_if(beside, [&](std::size_t i) {
      return std::abs(across.dot(direction_of(known[i]))) > max_sine;
    });
    const int steps = static_cast<int>(std::ceil(line.length_m() / kStepM));
    int covered = 0;
    for (int i = 0; i < steps; ++i) {
      const Eigen::Vector2d at_m = line.begin_m + (i + 0.5) / steps * (line.end_m - line.begin_m);
      if (std::any_of(beside.begin(), beside.end(), [&](std::size_t number) {
            return distance_m(at_m, known[number]) <= settings.reach_m;
          })) {
        ++covered;
      }
    }
    if (covered < settings.min_share * steps) others.push_back(line);
  }
  return others;
}

}  // namespace milepost
