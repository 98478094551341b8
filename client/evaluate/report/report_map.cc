// The drive in plan view: the roads and junctions of the map, the recorded path and the fixes.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "client/evaluate/report/report_figures.h"
#include "schema/page/report_layers.h"
#include "schema/page/report_numbers.h"
#include "schema/page/report_plan.h"

namespace milepost {
namespace {

constexpr double kDecimetre = 0.1;

// Classes of the absolute error. The dots also grow with the error, to be readable without colour.
struct ErrorClass {
  double up_to_m;
  const char* words;
  const char* colour;
  double radius_px;
};

constexpr std::array<ErrorClass, 6> kErrorClasses = {{
    {0.05, "error up to 0.05 m", "e0", 2.6},
    {0.1, "up to 0.1 m", "e1", 2.9},
    {0.2, "up to 0.2 m", "e2", 3.2},
    {0.5, "up to 0.5 m", "e3", 3.7},
    {1.0, "up to 1 m", "e4", 4.2},
    {std::numeric_limits<double>::infinity(), "more than 1 m", "e5", 4.8},
}};

std::size_t class_of(double error_m) {
  const auto* const found =
      std::find_if(kErrorClasses.begin(), kErrorClasses.end() - 1,
                   [&](const ErrorClass& each) { return std::abs(error_m) <= each.up_to_m; });
  return static_cast<std::size_t>(found - kErrorClasses.begin());
}

struct PlanView {
  std::vector<PlanPoint> driven;     // lines of the segments with a fix, each ended by a gap
  std::vector<PlanPoint> others;     // likewise, of the others
  std::vector<PlanPoint> junctions;  // ends of segments where ways part or join
  std::vector<PlanPoint> path;       // of the query, one per frame
  std::vector<PlanPoint> fixes;      // of the reference method, one per fix
};

std::optional<GeoPoint> origin_of(const ReportInput& input) {
  if (input.drive != nullptr) {
    for (const Frame& frame : input.drive->frames) {
      if (is_valid(frame.position)) return frame.position;
    }
  }
  for (const RoadAround& road : input.roads) {
    if (!road.line.empty()) return road.line.front();
  }
  return std::nullopt;
}

void add_road(PlanView& plan, const LocalFrame& frame, const RoadAround& road) {
  std::vector<PlanPoint>& lines = road.is_driven ? plan.driven : plan.others;
  for (const GeoPoint& point : road.line) lines.push_back(on_plan(frame, point));
  lines.push_back({kNaN, kNaN});
  if (road.begins_at_junction) plan.junctions.push_back(on_plan(frame, road.line.front()));
  if (road.ends_at_junction) plan.junctions.push_back(on_plan(frame, road.line.back()));
}

PlanView plan_view(const ReportInput& input, const ReportSeries& series, const GeoPoint& origin) {
  const LocalFrame frame(origin);
  PlanView plan;
  for (const RoadAround& road : input.roads) add_road(plan, frame, road);
  if (input.drive != nullptr) {
    for (const Frame& each : input.drive->frames) {
      plan.path.push_back(on_plan(frame, each.position));
    }
  }
  for (const EvaluatedFix& fix : series.reference_method().evaluation->fixes) {
    const std::optional<GeoPoint>& position = fix.frame.fix.position;
    plan.fixes.push_back(position ? on_plan(frame, *position) : PlanPoint{kNaN, kNaN});
  }
  return plan;
}

// The area around the drive: of the roads only what is near it, or a short drive would be tiny.
PlanArea area_of(const PlanView& plan) {
  constexpr double kLeastWidthM = 10;
  constexpr double kLeastHeightShare = 0.3;
  constexpr double kMostHeightShare = 0.62;
  PlanArea area;
  area.include(plan.path);
  area.include(plan.fixes);
  if (std::isnan(area.east.from)) area.include(plan.driven);
  const double margin_m = 0.06 * std::max(area.east.length(), area.north.length());
  area.east.widen_to(std::max(kLeastWidthM, area.east.length() + 2 * margin_m));
  area.north.widen_to(
      std::max(kLeastHeightShare * area.east.length(), area.north.length() + 2 * margin_m));
  area.east.widen_to(std::max(area.east.length(), area.north.length() / kMostHeightShare));
  return area;
}

void add_roads(Json& layers, const PlanView& plan) {
  if (!plan.others.empty()) {
    Json others = line_layer("other segment", "road", 4, easts(plan.others), norths(plan.others));
    others["opacity"] = 0.7;
    layers.push_back(others);
  }
  layers.push_back(
      line_layer("segment driven", "road", 9, easts(plan.driven), norths(plan.driven)));
}

void add_junctions(Json& layers, const PlanView& plan) {
  if (plan.junctions.empty()) return;
  layers.push_back(circles_layer("ways part or join", "ink", "page", 5, 2, easts(plan.junctions),
                                 norths(plan.junctions)));
}

// The largest errors are drawn on top.
void add_fixes(Json& layers, const PlanView& plan, const MethodSeries& method) {
  for (std::size_t k = 0; k < kErrorClasses.size(); ++k) {
    std::vector<PlanPoint> points;
    for (std::size_t i = 0; i < plan.fixes.size(); ++i) {
      const double error_m = method.error_m[i];
      if (!std::isnan(error_m) && class_of(error_m) == k) points.push_back(plan.fixes[i]);
    }
    const ErrorClass& each = kErrorClasses.at(k);
    layers.push_back(
        dots_layer(each.words, each.colour, each.radius_px, easts(points), norths(points)));
  }
}

Json frames_without_fix(const PlanView& plan, const MethodSeries& method) {
  std::vector<PlanPoint> points;
  for (std::size_t i = 0; i < std::min(plan.path.size(), method.error_m.size()); ++i) {
    if (std::isnan(method.error_m[i])) points.push_back(plan.path[i]);
  }
  return circles_layer("frame without a fix", "muted", "page", 2.5, 1.2, easts(points),
                       norths(points));
}

void add_ends(Json& layers, const std::vector<PlanPoint>& path) {
  const auto is_drawn = [](const PlanPoint& point) { return std::isfinite(point.x); };
  const auto start = std::find_if(path.begin(), path.end(), is_drawn);
  const auto end = std::find_if(path.rbegin(), path.rend(), is_drawn);
  if (start == path.end()) return;
  // The labels are placed away from the path.
  const bool heads_north = end->y >= start->y;
  const auto add = [&](const PlanPoint& at, const char* word, bool is_below) {
    const Json x = easts({at});
    const Json y = norths({at});
    layers.push_back(circles_layer("", "ink", "clear", 5, 1.5, x, y));
    layers.push_back(texts_layer(Json::array({word}), {"center", 0, is_below ? 20 : -10}, x, y));
  };
  add(*start, "start", heads_north);
  add(*end, "end", !heads_north);
}

std::string map_caption(const MethodSeries& method) {
  std::string text = "Metres east and north, to scale. Each dot is a fix of " + method.name +
                     "; larger dots have larger errors. The thin line is the recorded path.";
  const std::vector<double>& errors_m = method.localized_errors_m;
  if (errors_m.empty()) return text;
  const auto near = std::count_if(errors_m.begin(), errors_m.end(),
                                  [](double error_m) { return std::abs(error_m) <= kDecimetre; });
  return text + " " + std::to_string(near) + " of " + std::to_string(errors_m.size()) +
         " errors are at most 0.1 m.";
}

}  // namespace

Figure map_figure(const ReportInput& input, const ReportSeries& series) {
  Figure figure;
  figure.heading = "On the map";
  const std::optional<GeoPoint> origin = origin_of(input);
  if (!origin) return figure;
  const MethodSeries& reference = series.reference_method();
  figure.caption = map_caption(reference);
  const PlanView plan = plan_view(input, series, *origin);
  Json plot = plan_plot(area_of(plan),
                        "The roads of the map, the recorded path and the fixes in plan view");
  Json& layers = plot["layers"];
  add_roads(layers, plan);
  if (!plan.path.empty()) {
    layers.push_back(line_layer("recorded path", "muted", 1.2, "east_m", "north_m"));
  }
  layers.push_back(frames_without_fix(plan, reference));
  add_fixes(layers, plan, reference);
  add_junctions(layers, plan);
  add_ends(layers, plan.path);
  figure.plots.push_back(plot);
  return figure;
}

void add_places(Json& page, const ReportInput& input) {
  const std::optional<GeoPoint> origin = origin_of(input);
  if (!origin || input.drive == nullptr) return;
  const LocalFrame frame(*origin);
  std::vector<PlanPoint> path;
  for (const Frame& each : input.drive->frames) path.push_back(on_plan(frame, each.position));
  page["columns"]["east_m"] = easts(path);
  page["columns"]["north_m"] = norths(path);
  page["frames"]["east"] = "east_m";
  page["frames"]["north"] = "north_m";
}

}  // namespace milepost
