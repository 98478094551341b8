#include "schema/page/report_plan.h"

#include <cmath>

namespace milepost {
namespace {

constexpr int kDecimals = 3;

}  // namespace

PlanPoint on_plan(const LocalFrame& frame, const GeoPoint& point) {
  if (!is_valid(point)) return {std::nan(""), std::nan("")};
  const EnuPoint enu = frame.enu_from_geo(point);
  return {enu.east_m, enu.north_m};
}

void Extent::include(double value) {  // fmin and fmax ignore NaN
  from = std::fmin(from, value);
  to = std::fmax(to, value);
}

void Extent::widen_to(double length) {
  const double middle = (from + to) / 2;
  from = middle - length / 2;
  to = middle + length / 2;
}

void PlanArea::include(const std::vector<PlanPoint>& points) {
  for (const PlanPoint& point : points) {
    east.include(point.x);
    north.include(point.y);
  }
}

bool PlanArea::is_empty() const { return std::isnan(east.from) || std::isnan(north.from); }

bool PlanArea::contains(const PlanPoint& point) const {
  return east.contains(point.x) && north.contains(point.y);
}

Json plan_plot(const PlanArea& area, const std::string& description) {
  return {{"plan", true},
          {"description", description},
          {"x", axis("east (m)", area.east.from, area.east.to)},
          {"y", axis("north (m)", area.north.from, area.north.to)},
          {"layers", Json::array()}};
}

Json easts(const std::vector<PlanPoint>& points) {
  Json array = Json::array();
  for (const PlanPoint& point : points) array.push_back(rounded(point.x, kDecimals));
  return array;
}

Json norths(const std::vector<PlanPoint>& points) {
  Json array = Json::array();
  for (const PlanPoint& point : points) array.push_back(rounded(point.y, kDecimals));
  return array;
}

}  // namespace milepost
