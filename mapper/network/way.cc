#include "mapper/network/way.h"

#include <algorithm>
#include <cmath>

#include "mapper/network/geocentric.h"

namespace milepost {
namespace {

constexpr std::size_t kPositionReach = 3;  // states on either side that a position is averaged over
constexpr std::size_t kDirectionReach = 6;  // the same for a direction

// The mean of the points first to last.
Eigen::Vector3d mean_of(const std::vector<Eigen::Vector3d>& points_m, std::size_t first,
                        std::size_t last) {
  Eigen::Vector3d sum_m = Eigen::Vector3d::Zero();
  for (std::size_t i = first; i <= last; ++i) sum_m += points_m[i] - points_m[first];
  return points_m[first] + sum_m / static_cast<double>(last - first + 1);
}

Eigen::Vector3d smooth_position(const std::vector<Eigen::Vector3d>& points_m, std::size_t i) {
  const std::size_t reach = std::min({kPositionReach, i, points_m.size() - 1 - i});
  return mean_of(points_m, i - reach, i + reach);
}

// From the mean of the points behind to that of the points ahead; near an end, as where there first
// are enough of both.
Eigen::Vector3d direction_at(const std::vector<Eigen::Vector3d>& points_m, std::size_t i) {
  const std::size_t last = points_m.size() - 1;
  const std::size_t reach = std::min(kDirectionReach, last / 2);
  const std::size_t inside = std::clamp(i, reach, last - reach);
  return (mean_of(points_m, inside, std::min(last, inside + std::max<std::size_t>(reach, 1))) -
          mean_of(points_m, inside - reach, inside))
      .normalized();
}

Way way_along(const RouteLine& line) {
  Way way;
  way.length_m = line.length_m();
  way.has_altitudes = std::ranges::any_of(
      line.vertices(), [](const GeoPoint& vertex) { return vertex.altitude_m != 0; });
  way.states.resize(static_cast<std::size_t>(line.length_m()) + 1);
  std::vector<Eigen::Vector3d> points_m(way.states.size());
  for (std::size_t i = 0; i < points_m.size(); ++i) {
    const GeoPoint point = line.point_at(static_cast<double>(i));
    points_m[i] = geocentric(point);
    way.states[i].altitude_m = point.altitude_m;
  }
  for (std::size_t i = 0; i < points_m.size(); ++i) {
    way.states[i].position_m = smooth_position(points_m, i);
    way.states[i].forward = direction_at(points_m, i);
  }
  return way;
}

}  // namespace

std::vector<Way> ways_of(const NamedDrivenLines& drive, std::size_t drive_index) {
  std::vector<Way> ways;
  double begin_m = 0;
  for (std::size_t stretch = 0; stretch < drive.lines.size(); ++stretch) {
    Way way = way_along(drive.lines[stretch].line);
    way.drive = drive_index;
    way.stretch = stretch;
    way.begin_m = begin_m;
    begin_m += way.length_m;
    ways.push_back(std::move(way));
  }
  return ways;
}

std::size_t nearest_state(const Way& way, double along_m) {
  const auto last = static_cast<double>(way.states.size() - 1);
  return static_cast<std::size_t>(std::lround(std::clamp(along_m, 0.0, last)));
}

}  // namespace milepost
