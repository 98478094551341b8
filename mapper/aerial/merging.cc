#include "mapper/aerial/merging.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

#include "mapper/aerial/line_grid.h"
#include "schema/geo/geodesy.h"

namespace milepost {
namespace {

auto coordinates_of(const WallLine& line) {
  return std::tuple(line.begin_m.x(), line.begin_m.y(), line.end_m.x(), line.end_m.y());
}

// The longest first; equal lengths by coordinates, so that the input's order does not matter.
bool comes_before(const WallLine& a, const WallLine& b) {
  return std::tuple(-a.length_m(), coordinates_of(a)) <
         std::tuple(-b.length_m(), coordinates_of(b));
}

bool are_one(const WallLine& line, const WallLine& other, const MergingSettings& settings) {
  const Eigen::Vector2d along = direction_of(line);
  const Eigen::Vector2d across = right_of(along);
  if (std::abs(across.dot(direction_of(other))) > std::sin(settings.max_angle_deg * kRadPerDeg)) {
    return false;
  }
  const Eigen::Vector2d to_begin = other.begin_m - line.begin_m;
  const Eigen::Vector2d to_end = other.end_m - line.begin_m;
  if (std::abs(across.dot(to_begin)) > settings.max_apart_m ||
      std::abs(across.dot(to_end)) > settings.max_apart_m) {
    return false;
  }
  const auto [first_m, last_m] = std::minmax({along.dot(to_begin), along.dot(to_end)});
  return first_m <= line.length_m() + settings.max_gap_m && last_m >= -settings.max_gap_m;
}

// The least-squares line through both, weighted by length, from the first end to the last.
WallLine united(const WallLine& line, const WallLine& other) {
  const double length_m = line.length_m() + other.length_m();
  const Eigen::Vector2d middle = (line.length_m() * (line.begin_m + line.end_m) +
                                  other.length_m() * (other.begin_m + other.end_m)) /
                                 (2 * length_m);
  Eigen::Matrix2d moments = Eigen::Matrix2d::Zero();
  for (const WallLine* const part : {&line, &other}) {
    const Eigen::Vector2d from_middle = (part->begin_m + part->end_m) / 2 - middle;
    const Eigen::Vector2d way = part->end_m - part->begin_m;
    moments +=
        part->length_m() * (from_middle * from_middle.transpose() + way * way.transpose() / 12);
  }
  const double angle_rad = std::atan2(2 * moments(0, 1), moments(0, 0) - moments(1, 1)) / 2;
  Eigen::Vector2d along(std::cos(angle_rad), std::sin(angle_rad));
  if (along.dot(line.end_m - line.begin_m) < 0) along = -along;
  const auto [first_m, last_m] =
      std::minmax({along.dot(line.begin_m - middle), along.dot(line.end_m - middle),
                   along.dot(other.begin_m - middle), along.dot(other.end_m - middle)});
  return {middle + first_m * along, middle + last_m * along};
}

}  // namespace

WallLines merged(WallLines lines, const MergingSettings& settings) {
  std::sort(lines.begin(), lines.end(), comes_before);
  LineGrid grid(std::max(1.0, settings.max_gap_m + settings.max_apart_m));
  for (std::size_t i = 0; i < lines.size(); ++i) grid.add(i, lines[i]);
  std::vector<bool> is_gathered(lines.size(), false);
  WallLines gathered;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (is_gathered[i]) continue;
    WallLine line = lines[i];
    for (bool grew = true; grew;) {
      grew = false;
      for (const std::size_t other : grid.near(line)) {
        if (other <= i || is_gathered[other] || !are_one(line, lines[other], settings)) continue;
        line = united(line, lines[other]);
        is_gathered[other] = true;
        grew = true;
      }
    }
    gathered.push_back(line);
  }
  std::sort(gathered.begin(), gathered.end(), comes_before);
  return gathered;
}

}  // namespace milepost
