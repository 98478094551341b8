// The route in plan view: the segment, the recorded path and the fixes.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "client/evaluate/report/plot/chart.h"
#include "client/evaluate/report/plot/text.h"
#include "client/evaluate/report/report_figures.h"
#include "client/evaluate/report/report_plan.h"

namespace milepost {
namespace {

using plot::Chart;
using plot::Point;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kDecimetre = 0.1;

// Classes of the absolute error. Dots grow with the error, so that colour is not alone to tell.
struct ErrorClass {
  double up_to_m;
  const char* words;
  const char* css_class;
  double radius_px;
};

constexpr std::array<ErrorClass, 6> kErrorClasses = {{
    {0.05, "up to 0.05 m", "e0", 2.6},
    {0.1, "0.1 m", "e1", 2.9},
    {0.2, "0.2 m", "e2", 3.2},
    {0.5, "0.5 m", "e3", 3.7},
    {1.0, "1 m", "e4", 4.2},
    {std::numeric_limits<double>::infinity(), "more", "e5", 4.8},
}};

std::size_t class_of(double error_m) {
  const auto* const found =
      std::find_if(kErrorClasses.begin(), kErrorClasses.end() - 1,
                   [&](const ErrorClass& each) { return std::abs(error_m) <= each.up_to_m; });
  return static_cast<std::size_t>(found - kErrorClasses.begin());
}

struct PlanView {
  std::vector<Point> line;   // of the segment
  std::vector<Point> path;   // of the query, one a frame
  std::vector<Point> fixes;  // of the chief method, one a fix
};

std::optional<GeoPoint> origin_of(const ReportInput& input) {
  if (input.drive != nullptr) {
    for (const Frame& frame : input.drive->frames) {
      if (is_valid(frame.position)) return frame.position;
    }
  }
  for (const GeoPoint& point : input.segment_line) {
    if (is_valid(point)) return point;
  }
  return std::nullopt;
}

PlanView plan_view(const ReportInput& input, const ReportSeries& series, const GeoPoint& origin) {
  const LocalFrame frame(origin);
  PlanView plan;
  for (const GeoPoint& point : input.segment_line) plan.line.push_back(on_plan(frame, point));
  if (input.drive != nullptr) {
    for (const Frame& each : input.drive->frames) {
      plan.path.push_back(on_plan(frame, each.position));
    }
  }
  for (const EvaluatedFix& fix : series.chief_method().evaluation->fixes) {
    const std::optional<GeoPoint>& position = fix.frame.fix.position;
    plan.fixes.push_back(position ? on_plan(frame, *position) : Point{kNaN, kNaN});
  }
  return plan;
}

// Around what was driven. Of the segment's line only the part near it is shown: a long segment
// driven in part would leave the drive as a speck.
PlanArea area_of(const PlanView& plan) {
  constexpr double kLeastWidthM = 10;
  constexpr double kLeastHeightShare = 0.3;
  constexpr double kMostHeightShare = 0.62;
  PlanArea area;
  area.include(plan.path);
  area.include(plan.fixes);
  if (std::isnan(area.east.from)) area.include(plan.line);
  const double margin_m = 0.06 * std::max(area.east.length(), area.north.length());
  area.east.widen_to(std::max(kLeastWidthM, area.east.length() + 2 * margin_m));
  area.north.widen_to(
      std::max(kLeastHeightShare * area.east.length(), area.north.length() + 2 * margin_m));
  area.east.widen_to(std::max(area.east.length(), area.north.length() / kMostHeightShare));
  return area;
}

// The worst on top, where they cannot be missed.
void draw_fixes(Chart& chart, const PlanView& plan, const MethodSeries& method) {
  for (std::size_t k = 0; k < kErrorClasses.size(); ++k) {
    const ErrorClass& error_class = kErrorClasses.at(k);
    for (std::size_t i = 0; i < plan.fixes.size(); ++i) {
      const double error_m = method.error_m[i];
      if (std::isnan(error_m) || class_of(error_m) != k) continue;
      chart.circle(plan.fixes[i], error_class.radius_px, error_class.css_class,
                   method.evaluation->fixes[i].frame.filename + ": " +
                       plot::signed_number(error_m, 2) + " m");
    }
  }
}

void draw_frames_without_fix(Chart& chart, const PlanView& plan, const MethodSeries& method) {
  for (std::size_t i = 0; i < std::min(plan.path.size(), method.error_m.size()); ++i) {
    if (!std::isnan(method.error_m[i])) continue;
    chart.circle(plan.path[i], 2.5, "nofix",
                 method.evaluation->fixes[i].frame.filename + ": no fix");
  }
}

void draw_ends(Chart& chart, const std::vector<Point>& path) {
  const auto is_drawn = [](const Point& point) { return std::isfinite(point.x); };
  const auto start = std::find_if(path.begin(), path.end(), is_drawn);
  const auto end = std::find_if(path.rbegin(), path.rend(), is_drawn);
  if (start == path.end()) return;
  // Away from the path, which lies on the other side of each end's name.
  const bool heads_north = end->y >= start->y;
  chart.circle(*start, 5, "ring", "start");
  chart.circle(*end, 5, "ring", "end");
  chart.word(*start, 0, heads_north ? 20 : -10, "mid strong", "start");
  chart.word(*end, 0, heads_north ? -10 : 20, "mid strong", "end");
}

std::string map_legend(const MethodSeries& method) {
  std::string html =
      R"(<p class="legend"><span><svg width="18" height="8"><path class="road" )"
      R"(d="M1 4H17"/></svg>segment</span> <span><svg width="18" height="8"><path )"
      R"(class="path" d="M1 4H17"/></svg>recorded path</span> <span><svg width="10" )"
      R"(height="10"><circle class="nofix" cx="5" cy="5" r="2.5"/></svg>frame without a )"
      "fix</span></p>\n<p class=\"legend\"><span>error of " +
      plot::escaped(method.name) + "</span> ";
  for (const ErrorClass& each : kErrorClasses) {
    html += std::string(R"(<span><svg width="10" height="10"><circle class=")") + each.css_class +
            R"(" cx="5" cy="5" r=")" + plot::number(each.radius_px, 1) + R"("/></svg>)" +
            each.words + "</span> ";
  }
  return html + "</p>\n";
}

std::string map_caption(const MethodSeries& method) {
  std::string text = "Metres east and north, to scale. Each dot is a fix of " + method.name +
                     " on the segment's line; the darker line is where the camera really was.";
  const std::vector<double>& errors_m = method.localized_errors_m;
  if (errors_m.empty()) return text;
  const auto near = std::count_if(errors_m.begin(), errors_m.end(),
                                  [](double error_m) { return std::abs(error_m) <= kDecimetre; });
  return text + " " + std::to_string(near) + " of " + std::to_string(errors_m.size()) +
         " errors are at most a decimetre.";
}

}  // namespace

Figure map_figure(const ReportInput& input, const ReportSeries& series) {
  Figure figure;
  figure.heading = "On the map";
  const MethodSeries& chief = series.chief_method();
  figure.legend = map_legend(chief);
  const std::optional<GeoPoint> origin = origin_of(input);
  if (!origin) return figure;
  figure.caption = map_caption(chief);
  const PlanView plan = plan_view(input, series, *origin);
  const PlanArea area = area_of(plan);
  Chart chart = plan_chart(area, "The segment, the recorded path and the fixes in plan view");
  chart.line(plan.line, "road");
  chart.line(plan.path, "path");
  draw_frames_without_fix(chart, plan, chief);
  draw_fixes(chart, plan, chief);
  draw_ends(chart, plan.path);
  draw_scale_bar(chart, area);
  figure.drawing = chart.svg();
  return figure;
}

}  // namespace milepost
