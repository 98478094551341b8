#include "client/evaluate/report/report_plan.h"

#include <cmath>

#include "client/evaluate/report/plot/text.h"

namespace milepost {
namespace {

using plot::Axis;
using plot::Chart;
using plot::Point;

constexpr int kMostTicks = 7;

// Only so many ticks that both axes have the same step.
Axis same_step_axis(const std::string& label, const Extent& extent, double step) {
  return Axis::spanning(label, extent.from, extent.to,
                        static_cast<int>(std::ceil(extent.length() / step)));
}

}  // namespace

Point on_plan(const LocalFrame& frame, const GeoPoint& point) {
  if (!is_valid(point)) return {std::nan(""), std::nan("")};
  const EnuPoint enu = frame.enu_from_geo(point);
  return {enu.east_m, enu.north_m};
}

void Extent::include(double value) {  // fmin and fmax pass over NaN
  from = std::fmin(from, value);
  to = std::fmax(to, value);
}

void Extent::widen_to(double length) {
  const double middle = (from + to) / 2;
  from = middle - length / 2;
  to = middle + length / 2;
}

void PlanArea::include(const std::vector<Point>& points) {
  for (const Point& point : points) {
    east.include(point.x);
    north.include(point.y);
  }
}

bool PlanArea::is_empty() const { return std::isnan(east.from) || std::isnan(north.from); }

bool PlanArea::contains(const Point& point) const {
  return east.contains(point.x) && north.contains(point.y);
}

Chart plan_chart(const PlanArea& area, const std::string& description) {
  const double step = plot::round_ticks(area.east.from, area.east.to, kMostTicks).step;
  return Chart::of_equal_units(same_step_axis("east (m)", area.east, step),
                               same_step_axis("north (m)", area.north, step), description);
}

void draw_scale_bar(Chart& chart, const PlanArea& area) {
  const double length_m = plot::round_ticks(0, area.east.length(), 6).step;
  const double right = area.east.to - 0.03 * area.east.length();
  const double y = area.north.from + 0.07 * area.north.length();
  const std::vector<Point> bar = {{right - length_m, y}, {right, y}};
  chart.line(bar, "casing");
  chart.line(bar, "scale");
  chart.word({right - length_m / 2, y}, 0, -7, "mid strong",
             plot::number(length_m, plot::round_ticks(0, length_m, 1).decimals) + " m");
}

}  // namespace milepost
