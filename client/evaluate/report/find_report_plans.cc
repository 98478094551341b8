// Plans of the report of a found drive: the belief at several times, and the whole path.
#include <cmath>
#include <numbers>

#include "client/evaluate/report/find_plan_areas.h"
#include "client/evaluate/report/find_report_figures.h"
#include "client/evaluate/report/find_status_marks.h"
#include "client/evaluate/report/plot/chart.h"
#include "client/evaluate/report/plot/text.h"
#include "client/evaluate/report/report_numbers.h"

namespace milepost {
namespace {

using plot::Chart;
using plot::Point;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr Point kGap = {kNaN, kNaN};
constexpr std::size_t kMostDots = 600;

void draw_particles(Chart& chart, const FindSnapshot& snapshot, const PlanArea& area) {
  const double tick_m = 0.02 * area.east.length();
  std::vector<Point> places;
  std::vector<Point> ticks;
  for (const PlanPose& pose : snapshot.particles) {
    const Point place = {pose.enu_m.x(), pose.enu_m.y()};
    if (!area.contains(place)) continue;
    const Eigen::Vector2d tip = pose.enu_m + tick_m * direction_of(pose.heading_rad);
    places.push_back(place);
    ticks.insert(ticks.end(), {place, {tip.x(), tip.y()}, kGap});
  }
  chart.line(ticks, "particle tick");
  chart.dots(places, "particle");
}

// On pictures a line needs a light or dark edge.
void draw_cased(Chart& chart, const std::vector<Point>& points, const std::string& css_class) {
  chart.line(points, "casing");
  chart.line(points, css_class);
}

std::vector<Point> circle_about(const Point& middle, double radius_m) {
  constexpr int kCorners = 72;
  std::vector<Point> points;
  for (int k = 0; k <= kCorners; ++k) {
    const double angle_rad = 2 * std::numbers::pi * k / kCorners;
    points.push_back(
        {middle.x + radius_m * std::cos(angle_rad), middle.y + radius_m * std::sin(angle_rad)});
  }
  return points;
}

// In the upper right corner.
void draw_north_arrow(Chart& chart, const PlanArea& area) {
  const Point corner = {area.east.to, area.north.to};
  for (const char* css_class : {"casing", "north"}) {
    chart.symbol(corner, -20, 40, css_class, "north");
  }
  chart.word(corner, -20, 55, "mid strong", "N");
}

// The densest place with its heading, and while tracked a circle of two sigmas.
void draw_estimate(Chart& chart, const Point& at, const FindFix& fix, const PlanArea& area) {
  const Eigen::Vector2d way =
      0.06 * area.east.length() * direction_of(fix.heading_deg * kRadPerDeg);
  draw_cased(chart, {at, {at.x + way.x(), at.y + way.y()}}, "m0 line chief");
  if (is_tracked(fix.status)) {
    draw_cased(chart, circle_about(at, 2 * fix.sigma_m), "m0 line chief");
  }
  chart.circle(at, 3, "f-tracking", "densest place, \u03C3 " + metres(fix.sigma_m));
}

std::vector<Point> until(const std::vector<Point>& path, std::size_t frame) {
  return {path.begin(), path.begin() + static_cast<std::ptrdiff_t>(frame) + 1};
}

// Gaps where the vehicle was not tracked.
std::vector<Point> tracked_path(const FoundSeries& series) {
  std::vector<Point> path = series.found;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (!is_tracked((*series.input->frames)[i].fix.status)) path[i] = kGap;
  }
  return path;
}

std::string time_text(double time_s) { return plot::number(time_s, 1) + " s"; }

std::string moment_of(const FoundSeries& series, std::size_t frame) {
  if (series.summary.found_frame == frame) return "found";
  if (frame == 0) return "start";
  if (frame + 1 == series.time_s.size()) return "end";
  return name_of((*series.input->frames)[frame].fix.status);
}

std::string snapshot_caption(const FoundSeries& series, std::size_t frame, bool is_close_up) {
  const FindFix& fix = (*series.input->frames)[frame].fix;
  const double error_m = series.errors[frame].position_m;
  std::string text = std::string(is_close_up ? "Close-up" : "The whole area") + "; status " +
                     name_of(fix.status) + ", \u03C3 " + metres(fix.sigma_m) + ", " +
                     plot::number(100 * fix.mass, 0) +
                     "\u00A0% of the belief in the densest place.";
  if (std::isfinite(error_m)) text += " Off by " + metres(error_m) + ".";
  return text;
}

Figure snapshot_figure(const FoundSeries& series, std::size_t number) {
  const FindSnapshot& snapshot = series.snapshots[number];
  const std::size_t frame = snapshot.frame;
  const std::optional<PlanArea> close_up = close_up_area(series, snapshot);
  const PlanArea area = close_up.value_or(whole_area(series));
  Figure figure;
  figure.heading = std::to_string(number + 1) + "\u2002" + time_text(series.time_s[frame]) + ": " +
                   moment_of(series, frame);
  figure.caption = snapshot_caption(series, frame, close_up.has_value());
  Chart chart = plan_chart(area, "Walls, particles, paths and estimate: " + figure.heading);
  chart.shared(kPlanGround);
  draw_particles(chart, snapshot, area);
  draw_cased(chart, until(series.recorded, frame), "recorded");
  draw_cased(chart, until(tracked_path(series), frame), "m0 line chief");
  chart.circle(series.recorded[frame], 5, "here", "where the camera really was");
  draw_estimate(chart, series.found[frame], (*series.input->frames)[frame].fix, area);
  draw_north_arrow(chart, area);
  draw_scale_bar(chart, area);
  figure.drawing = chart.svg();
  return figure;
}

std::string dot_text(const FoundSeries& series, std::size_t frame) {
  const FoundFrame& found = (*series.input->frames)[frame];
  std::string text =
      found.filename + ", " + time_text(series.time_s[frame]) + ": " + name_of(found.fix.status);
  const double error_m = series.errors[frame].position_m;
  return std::isfinite(error_m) ? text + ", off by " + metres(error_m) : text;
}

std::size_t dot_stride(const FoundSeries& series) { return series.found.size() / kMostDots + 1; }

void draw_found(Chart& chart, const FoundSeries& series) {
  const std::size_t stride = dot_stride(series);
  for (const FindStatusMark& mark : kFindStatusMarks) {
    for (std::size_t i = 0; i < series.found.size(); i += stride) {
      if ((*series.input->frames)[i].fix.status != mark.status) continue;
      chart.circle(series.found[i], mark.radius_px, mark.dot_class, dot_text(series, i));
    }
  }
}

void draw_snapshot_numbers(Chart& chart, const FoundSeries& series) {
  for (std::size_t k = 0; k < series.snapshots.size(); ++k) {
    const Point& at = series.recorded[series.snapshots[k].frame];
    chart.circle(at, 5, "here", "snapshot " + std::to_string(k + 1));
    chart.word(at, 9, -6, "strong", std::to_string(k + 1));
  }
}

std::string line_key(const std::string& css_class, const std::string& words) {
  return R"(<span><svg width="18" height="8"><path class=")" + css_class +
         R"(" d="M1 4H17"/></svg>)" + words + "</span> ";
}

std::string dot_key(const std::string& css_class, const std::string& words) {
  return R"(<span><svg width="12" height="12"><circle class=")" + css_class +
         R"(" cx="6" cy="6" r="4"/></svg>)" + words + "</span> ";
}

std::string path_legend() {
  std::string html = R"(<p class="legend">)" + line_key("recorded", "recorded path");
  for (const FindStatusMark& mark : kFindStatusMarks) {
    html += dot_key(mark.dot_class, name_of(mark.status));
  }
  return html + dot_key("here", "snapshot") + "</p>\n";
}

}  // namespace

std::string plan_legend() {
  return R"(<p class="legend">)" + line_key("wall", "wall") +
         line_key("particle", "particle, with its heading") +
         line_key("recorded", "recorded path so far") + dot_key("here", "where it really is") +
         line_key("m0 line chief", "tracked path so far") +
         dot_key("f-tracking", "densest place, with its heading and, while tracked, 2\u03C3") +
         "</p>\n";
}

std::vector<Figure> snapshot_figures(const FoundSeries& series) {
  std::vector<Figure> figures;
  for (std::size_t k = 0; k < series.snapshots.size(); ++k) {
    figures.push_back(snapshot_figure(series, k));
  }
  return figures;
}

Figure path_figure(const FoundSeries& series) {
  Figure figure;
  figure.heading = "The whole path";
  figure.legend = path_legend();
  const std::size_t stride = dot_stride(series);
  figure.caption =
      "Metres east and north, to scale. Each dot is where the belief was densest in a frame" +
      (stride > 1 ? ", one of " + std::to_string(stride) + " frames" : std::string()) +
      "; the line is where the camera really was. While nothing is found the densest place jumps, "
      "and dots outside the plan are not drawn. Numbers are those of the snapshots.";
  const PlanArea area = path_area(series);
  Chart chart = plan_chart(area, "The recorded path and what was found in plan view");
  chart.shared(kPlanGround);
  draw_cased(chart, series.recorded, "recorded");
  draw_found(chart, series);
  draw_snapshot_numbers(chart, series);
  draw_north_arrow(chart, area);
  draw_scale_bar(chart, area);
  figure.drawing = chart.svg();
  return figure;
}

}  // namespace milepost
