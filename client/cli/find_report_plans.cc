// Plans of the report of a found drive: the belief at several times, and the whole path.
#include <sodium.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "client/cli/find_report_figures.h"
#include "client/cli/find_status_marks.h"
#include "client/cli/plot/chart.h"
#include "client/cli/plot/text.h"
#include "client/cli/report_numbers.h"
#include "client/cli/report_plan.h"

namespace milepost {
namespace {

using plot::Chart;
using plot::coordinate;
using plot::Point;

constexpr const char* kGround = "ground";
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr Point kGap = {kNaN, kNaN};
constexpr double kHeightShare = 0.8;  // of a plan's width
constexpr double kCloseUpM = 80;      // its width
constexpr double kCloseUpMass = 0.9;  // of the belief, at least, is in a close-up
constexpr std::size_t kMostDots = 600;

std::string base64_of(ByteView bytes) {
  std::string text(sodium_base64_ENCODED_LEN(bytes.size(), sodium_base64_VARIANT_ORIGINAL), '\0');
  sodium_bin2base64(text.data(), text.size(), bytes.data(), bytes.size(),
                    sodium_base64_VARIANT_ORIGINAL);
  text.pop_back();  // the terminating zero
  return text;
}

// The picture's two sides are straight and even in metres, as far as a plan reaches.
std::string image_of(const Backdrop& backdrop, const LocalFrame& frame) {
  const Point origin = on_plan(frame, backdrop.top_left);
  const Point right = on_plan(frame, backdrop.top_right);
  const Point down = on_plan(frame, backdrop.bottom_left);
  const auto metre = [](double value) { return coordinate(value, 3); };
  return R"(<image class="backdrop" width="1" height="1" preserveAspectRatio="none" )"
         "transform=\"matrix(" +
         metre(right.x - origin.x) + " " + metre(origin.y - right.y) + " " +
         metre(down.x - origin.x) + " " + metre(origin.y - down.y) + " " + metre(origin.x) + " " +
         metre(-origin.y) + ")\" href=\"data:image/jpeg;base64," + base64_of(backdrop.jpeg) +
         "\"/>\n";
}

std::string walls_of(const std::vector<PlanWall>& walls) {
  std::string data;
  const auto place = [](const Eigen::Vector2d& enu_m) {
    return coordinate(enu_m.x(), 2) + " " + coordinate(-enu_m.y(), 2);
  };
  for (const PlanWall& wall : walls) data += "M" + place(wall.begin_m) + "L" + place(wall.end_m);
  return R"(<path class="wall" d=")" + data + "\"/>\n";
}

PlanArea of_even_shape(PlanArea area, double least_width_m) {
  const double width_m =
      std::max({least_width_m, area.east.length() * 1.1, area.north.length() * 1.1 / kHeightShare});
  area.east.widen_to(width_m);
  area.north.widen_to(width_m * kHeightShare);
  return area;
}

PlanArea whole_area(const FoundSeries& series) {
  PlanArea area;
  for (const PlanWall& wall : series.input->recorder->walls()) {
    area.include({{wall.begin_m.x(), wall.begin_m.y()}, {wall.end_m.x(), wall.end_m.y()}});
  }
  area.include(series.recorded);
  return of_even_shape(area, kCloseUpM);
}

bool contains(const PlanArea& area, const Eigen::Vector2d& enu_m) {
  return area.east.from <= enu_m.x() && enu_m.x() <= area.east.to && area.north.from <= enu_m.y() &&
         enu_m.y() <= area.north.to;
}

PlanArea close_up(const Point& middle) {
  PlanArea area;
  area.include({middle});
  return of_even_shape(area, kCloseUpM);
}

bool holds_belief(const PlanArea& area, const FindSnapshot& snapshot) {
  const auto inside =
      std::count_if(snapshot.particles.begin(), snapshot.particles.end(),
                    [&](const PlanPose& pose) { return contains(area, pose.enu_m); });
  return static_cast<double>(inside) >=
         kCloseUpMass * static_cast<double>(snapshot.particles.size());
}

void draw_particles(Chart& chart, const FindSnapshot& snapshot, const PlanArea& area) {
  const double tick_m = 0.02 * area.east.length();
  std::vector<Point> places;
  std::vector<Point> ticks;
  for (const PlanPose& pose : snapshot.particles) {
    if (!contains(area, pose.enu_m)) continue;
    const Eigen::Vector2d tip = pose.enu_m + tick_m * direction_of(pose.heading_rad);
    places.push_back({pose.enu_m.x(), pose.enu_m.y()});
    ticks.insert(ticks.end(), {places.back(), {tip.x(), tip.y()}, kGap});
  }
  chart.line(ticks, "particle tick");
  chart.dots(places, "particle");
}

void draw_circle(Chart& chart, const Point& middle, double radius_m, const std::string& css_class) {
  constexpr int kCorners = 72;
  std::vector<Point> points;
  for (int k = 0; k <= kCorners; ++k) {
    const double angle_rad = 2 * std::numbers::pi * k / kCorners;
    points.push_back(
        {middle.x + radius_m * std::cos(angle_rad), middle.y + radius_m * std::sin(angle_rad)});
  }
  chart.line(points, css_class);
}

// In the upper right corner.
void draw_north_arrow(Chart& chart, const PlanArea& area) {
  const double unit_m = area.east.length() / 100;
  const double x = area.east.to - 4 * unit_m;
  const double tip = area.north.to - 3 * unit_m;
  const std::vector<Point> arrow = {{x, tip - 8 * unit_m},
                                    {x, tip},
                                    kGap,
                                    {x - 1.5 * unit_m, tip - 2.5 * unit_m},
                                    {x, tip},
                                    {x + 1.5 * unit_m, tip - 2.5 * unit_m}};
  chart.line(arrow, "casing");
  chart.line(arrow, "north");
  chart.word({x, tip - 8 * unit_m}, 0, 15, "mid strong", "N");
}

void draw_estimate(Chart& chart, const Point& at, const FindFix& fix, const PlanArea& area) {
  const double heading_rad = fix.heading_deg * kRadPerDeg;
  const Eigen::Vector2d way = 0.05 * area.east.length() * direction_of(heading_rad);
  const std::vector<Point> tick = {at, {at.x + way.x(), at.y + way.y()}};
  draw_circle(chart, at, 2 * fix.sigma_m, "casing");
  chart.line(tick, "casing");
  draw_circle(chart, at, 2 * fix.sigma_m, "m0 line chief");
  chart.line(tick, "m0 line chief");
  chart.circle(at, 4, "f-tracking", "estimate, \u03C3 " + plot::number(fix.sigma_m, 2) + " m");
}

void draw_recorded(Chart& chart, const std::vector<Point>& recorded, const std::string& css_class) {
  chart.line(recorded, "casing");
  chart.line(recorded, css_class);
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

Figure snapshot_figure(const FoundSeries& series, std::size_t number, const PlanArea& whole) {
  const FindSnapshot& snapshot = series.snapshots[number];
  const std::size_t frame = snapshot.frame;
  const FindFix& fix = (*series.input->frames)[frame].fix;
  const Point& estimate = series.found[frame];
  Figure figure;
  figure.heading = std::to_string(number + 1) + "\u2002" + time_text(series.time_s[frame]) + ", " +
                   moment_of(series, frame);
  const bool is_close_up = is_tracked(fix.status) && holds_belief(close_up(estimate), snapshot);
  figure.caption = snapshot_caption(series, frame, is_close_up);
  const PlanArea area = is_close_up ? close_up(estimate) : whole;
  Chart chart = plan_chart(area, "Walls, particles, recorded path and estimate: " + figure.heading);
  chart.shared(kGround);
  draw_particles(chart, snapshot, area);
  draw_recorded(
      chart,
      {series.recorded.begin(), series.recorded.begin() + static_cast<std::ptrdiff_t>(frame) + 1},
      "recorded");
  if (std::isfinite(series.recorded[frame].x)) {
    chart.circle(series.recorded[frame], 5, "here", "where the camera really was");
  }
  draw_estimate(chart, estimate, fix, area);
  draw_north_arrow(chart, area);
  draw_scale_bar(chart, area);
  figure.drawing = chart.svg();
  return figure;
}

PlanArea path_area(const FoundSeries& series) {
  PlanArea area;
  area.include(series.recorded);
  for (std::size_t i = 0; i < series.found.size(); ++i) {
    if (is_tracked((*series.input->frames)[i].fix.status)) area.include({series.found[i]});
  }
  return area.is_empty() ? whole_area(series) : of_even_shape(area, kCloseUpM);
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
    if (!std::isfinite(at.x)) continue;
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

std::string plan_ground(const FindReportInput& input) {
  const LocalFrame frame(input.recorder->origin());
  return std::string(R"(<svg class="defs" aria-hidden="true"><defs><g id=")") + kGround + "\">\n" +
         (input.backdrop ? image_of(*input.backdrop, frame) : "") +
         walls_of(input.recorder->walls()) + "</g></defs></svg>\n";
}

std::string plan_legend() {
  return R"(<p class="legend">)" + line_key("wall", "wall") +
         line_key("particle", "particle, with its heading") +
         line_key("recorded", "recorded path so far") + dot_key("here", "where it really is") +
         dot_key("f-tracking", "estimate, with a circle of 2\u03C3") + "</p>\n";
}

std::vector<Figure> snapshot_figures(const FoundSeries& series) {
  const PlanArea whole = whole_area(series);
  std::vector<Figure> figures;
  for (std::size_t k = 0; k < series.snapshots.size(); ++k) {
    figures.push_back(snapshot_figure(series, k, whole));
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
  chart.shared(kGround);
  draw_recorded(chart, series.recorded, "recorded");
  draw_found(chart, series);
  draw_snapshot_numbers(chart, series);
  draw_north_arrow(chart, area);
  draw_scale_bar(chart, area);
  figure.drawing = chart.svg();
  return figure;
}

}  // namespace milepost
