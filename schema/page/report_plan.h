// Common parts of the reports' plan views: the area shown and its plot.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "schema/geo/geodesy.h"
#include "schema/page/report_json.h"

namespace milepost {

// Metres east and north.
struct PlanPoint {
  double x = 0;
  double y = 0;
};

// The point relative to the frame's origin; NaN if the position is not valid.
PlanPoint on_plan(const LocalFrame& frame, const GeoPoint& point);

// The range of the included values; NaN before the first.
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

  void include(const std::vector<PlanPoint>& points);
  bool is_empty() const;
  bool contains(const PlanPoint& point) const;  // borders included
};

// A plot of the area, to scale, without layers: {plan, description, x, y, layers}. REQUIRES: the
// area is not empty.
Json plan_plot(const PlanArea& area, const std::string& description);

// East and north of each point, in metres to the millimetre, for a layer's x and y.
Json easts(const std::vector<PlanPoint>& points);
Json norths(const std::vector<PlanPoint>& points);

}  // namespace milepost
