#include "tests/simulator/site.h"

#include <algorithm>
#include <cmath>

namespace milepost::simulator {

Point Site::on_ground(const cv::Vec2d& position) const {
  return {position[0], position[1], network_.terrain.height_m(position)};
}

bool Site::is_built_on(const cv::Vec2d& position, double margin_m) const {
  return std::any_of(buildings_.begin(), buildings_.end(), [&](const Building& building) {
    const auto& outline = building.footprint;
    for (int i = 0; i < 4; ++i) {
      const cv::Vec2d edge = cv::normalize(outline[(i + 1) % 4] - outline[i]);
      const cv::Vec2d offset = position - outline[i];
      if (offset[0] * edge[1] - offset[1] * edge[0] > margin_m) return false;
    }
    return true;
  });
}

std::optional<Standing> Site::beside(const Road& road, double along_m, int side,
                                     double off_m) const {
  const cv::Vec2d at = road.path.position_at({along_m, side * (road.half_width_m + off_m)});
  for (const Road& other : network_.roads) {
    if (&other == &road) continue;
    if (std::abs(other.path.place_of(at).lateral_m) < other.half_width_m + 1) return std::nullopt;
  }
  // A loop comes back to itself.
  if (std::abs(road.path.place_of(at).lateral_m) < road.half_width_m + off_m - 0.05) {
    return std::nullopt;
  }
  for (const Bridge& bridge : network_.bridges) {
    if (&road == &network_.roads[bridge.upper] && bridge.is_over(at)) return std::nullopt;
  }
  if (is_built_on(at, 0.2)) return std::nullopt;
  const double heading = road.path.heading_rad_at(along_m);
  return Standing{on_ground(at), forward_of(heading), right_of(heading) * -side};
}

bool Site::is_near_junction(const Road& road, double along_m) const {
  constexpr double kClearM = 10;
  const cv::Vec2d at = road.path.position_at({along_m, 0});
  return std::any_of(network_.roads.begin(), network_.roads.end(), [&](const Road& other) {
    const double distance = std::abs(other.path.place_of(at).lateral_m);
    return &other != &road && distance < other.half_width_m + kClearM;
  });
}

}  // namespace milepost::simulator
