// What the reports' plan views share: the area that is shown, and the chart for it.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "client/evaluate/report/plot/chart.h"
#include "schema/geo/geodesy.h"

namespace milepost {

// Metres east and north of the frame's origin; NaN where the position is not valid.
plot::Point on_plan(const LocalFrame& frame, const GeoPoint& point);

// From the least to the greatest of the values that were included; NaN before the first.
struct Extent {
  double from = std::numeric_limits<double>::quiet_NaN();
  double to = std::numeric_limits<double>::quiet_NaN();

  void include(double value);  // NaN changes nothing
  double length() const { return to - from; }
  bool contains(double value) const { return from <= value && value <= to; }
  void widen_to(double length);  // about its middle
};

struct PlanArea {
  Extent east;
  Extent north;

  void include(const std::vector<plot::Point>& points);
  bool is_empty() const;
  bool contains(const plot::Point& point) const;  // borders included
};

// A chart of the area, in metres and to scale; both axes have ticks equally far apart.
// REQUIRES: the area is not empty.
plot::Chart plan_chart(const PlanArea& area, const std::string& description);

// In the lower right corner, legible on pictures too.
void draw_scale_bar(plot::Chart& chart, const PlanArea& area);

}  // namespace milepost
