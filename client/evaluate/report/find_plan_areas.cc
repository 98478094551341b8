#include "client/evaluate/report/find_plan_areas.h"

#include <algorithm>
#include <cmath>

namespace milepost {
namespace {

constexpr double kHeightShare = 0.8;   // relative to a plan's width
constexpr double kLeastWidthM = 80;    // except for close-ups
constexpr double kCloseUpM = 32;       // width of a close-up
constexpr double kCloseUpShare = 0.9;  // least part of the particles in a close-up

PlanArea of_even_shape(PlanArea area, double least_width_m) {
  const double width_m =
      std::max({least_width_m, area.east.length() * 1.1, area.north.length() * 1.1 / kHeightShare});
  area.east.widen_to(width_m);
  area.north.widen_to(width_m * kHeightShare);
  return area;
}

}  // namespace

PlanArea whole_area(const FoundSeries& series) {
  PlanArea area;
  for (const PlanWall& wall : series.input->recorder->walls()) {
    area.include({{wall.begin_m.x(), wall.begin_m.y()}, {wall.end_m.x(), wall.end_m.y()}});
  }
  area.include(series.recorded);
  return of_even_shape(area, kLeastWidthM);
}

PlanArea path_area(const FoundSeries& series) {
  PlanArea area;
  area.include(series.recorded);
  for (std::size_t i = 0; i < series.found.size(); ++i) {
    if (is_tracked((*series.input->frames)[i].fix.status)) area.include({series.found[i]});
  }
  return area.is_empty() ? whole_area(series) : of_even_shape(area, kLeastWidthM);
}

std::optional<PlanArea> close_up_area(const FoundSeries& series, const FindSnapshot& snapshot) {
  PlanArea area;
  area.include({series.found[snapshot.frame]});
  area = of_even_shape(area, kCloseUpM);
  const PlanPoint& recorded = series.recorded[snapshot.frame];
  if (std::isfinite(recorded.x) && !area.contains(recorded)) return std::nullopt;
  const auto inside =
      std::count_if(snapshot.particles.begin(), snapshot.particles.end(), [&](const Pose2& pose) {
        return area.contains({pose.enu_m.x(), pose.enu_m.y()});
      });
  if (static_cast<double>(inside) <
      kCloseUpShare * static_cast<double>(snapshot.particles.size())) {
    return std::nullopt;
  }
  return area;
}

Bounds shown_bounds(const FoundSeries& series) {
  PlanArea area = whole_area(series);
  const PlanArea path = path_area(series);
  area.include({{path.east.from, path.north.from}, {path.east.to, path.north.to}});
  // A close-up extends at most this much further.
  area.east.widen_to(area.east.length() + kCloseUpM);
  area.north.widen_to(area.north.length() + kCloseUpM);
  const LocalFrame frame(series.input->recorder->origin());
  const GeoPoint south_west = frame.geo_from_enu({area.east.from, area.north.from, 0});
  const GeoPoint north_east = frame.geo_from_enu({area.east.to, area.north.to, 0});
  return {south_west.longitude_deg, south_west.latitude_deg, north_east.longitude_deg,
          north_east.latitude_deg};
}

}  // namespace milepost
