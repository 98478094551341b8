// What happened along the route: errors, matches and latency, frame by frame.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "client/evaluate/report/plot/chart.h"
#include "client/evaluate/report/plot/text.h"
#include "client/evaluate/report/report_figures.h"
#include "client/evaluate/report/report_numbers.h"
#include "client/evaluate/statistics.h"

namespace milepost {
namespace {

using plot::Axis;
using plot::Chart;
using plot::HoverStrip;
using plot::Point;

constexpr std::size_t kMostInLine = 600;  // frames; a line through more is one thick smear
constexpr std::size_t kMostStrips = 500;  // more would be narrower than a pointer can hit

struct StatusMark {
  FixStatus status;
  const char* word;
  const char* css_class;
};

// Tracking is the rule and has no mark.
constexpr std::array<StatusMark, 4> kStatusMarks = {{
    {FixStatus::initializing, "initializing", "s-initializing"},
    {FixStatus::predicted, "predicted", "s-predicted"},
    {FixStatus::lost, "lost", "s-lost"},
    {FixStatus::off_map, "off-map", "s-off-map"},
}};

const StatusMark* mark_of(FixStatus status) {
  const auto* const found = std::find_if(kStatusMarks.begin(), kStatusMarks.end(),
                                         [&](const StatusMark& m) { return m.status == status; });
  return found == kStatusMarks.end() ? nullptr : found;
}

std::string word_of(FixStatus status) {
  const StatusMark* mark = mark_of(status);
  return mark == nullptr ? "tracking" : mark->word;
}

Axis route_axis(const ReportSeries& series) {
  return Axis::spanning(series.route_label, series.route_from_m, series.route_to_m);
}

bool has_route(const ReportSeries& series) { return std::isfinite(series.route_from_m); }

std::string unplaced_text(const MethodSeries& method) {
  const auto unplaced = static_cast<std::size_t>(std::count_if(
      method.route_m.begin(), method.route_m.end(), [](double x) { return std::isnan(x); }));
  if (unplaced == 0) return "";
  return " Not drawn: " + counted(unplaced, "frame") + " of " + method.name +
         " without a true position.";
}

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// Signed errors that are drawn along the route, and the sigma that a fix claims for them.
struct ErrorKind {
  std::vector<double> MethodSeries::*error_m;
  double (*sigma_m)(const Fix&);  // NaN where none is claimed
};

constexpr ErrorKind kAlong = {&MethodSeries::error_m,
                              [](const Fix& fix) { return fix.along_m ? fix.sigma_m : kNaN; }};
constexpr ErrorKind kLateral = {&MethodSeries::lateral_error_m,
                                [](const Fix& fix) { return fix.lateral_sigma_m.value_or(kNaN); }};

std::vector<Point> error_points(const MethodSeries& method, const ErrorKind& kind) {
  const std::vector<double>& error_m = method.*kind.error_m;
  std::vector<Point> points;
  for (std::size_t i = 0; i < error_m.size(); ++i) {
    points.push_back({method.route_m[i], error_m[i]});
  }
  return points;
}

std::vector<Point> two_sigma_points(const MethodSeries& method, const ErrorKind& kind) {
  std::vector<Point> points;
  for (std::size_t i = 0; i < method.route_m.size(); ++i) {
    const double sigma_m = kind.sigma_m(method.evaluation->fixes[i].frame.fix);
    points.push_back({std::isfinite(sigma_m) ? method.route_m[i] : kNaN, 2 * sigma_m});
  }
  return points;
}

// Lateral and heading of a frame, where they are known.
std::string pose_text(const MethodSeries& method, std::size_t i) {
  std::string text;
  if (std::isfinite(method.lateral_error_m[i])) {
    text += ", lateral " + plot::signed_number(method.lateral_error_m[i], 3) + " m";
  }
  if (std::isfinite(method.heading_error_deg[i])) {
    text += ", heading " + plot::signed_number(method.heading_error_deg[i], 2) + "\u00B0";
  }
  return text;
}

std::string hover_text(const ReportSeries& series, std::size_t i) {
  const FrameFix& frame = series.chief_method().evaluation->fixes[i].frame;
  std::string text =
      frame.filename + ", " + plot::number(series.chief_method().route_m[i], 1) + " m";
  for (const MethodSeries& method : series.methods) {
    if (i >= method.error_m.size()) continue;
    const FrameFix& fix = method.evaluation->fixes[i].frame;
    text += "\n" + method.name + ": ";
    text += std::isnan(method.error_m[i])
                ? "no fix"
                : plot::signed_number(method.error_m[i], 3) + " m (\u03C3 " +
                      plot::number(fix.fix.sigma_m, 3) + " m)";
    text += pose_text(method, i) + ", " + word_of(fix.fix.status) +
            ", matches: " + std::to_string(fix.fix.matches);
  }
  return text;
}

// The frames with a place on the route, in its order.
std::vector<std::size_t> frames_along_route(const MethodSeries& method) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < method.route_m.size(); ++i) {
    if (!std::isnan(method.route_m[i])) order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return method.route_m[a] < method.route_m[b];
  });
  return order;
}

// Each strip reaches half way to its neighbours.
std::vector<HoverStrip> hover_strips(const ReportSeries& series) {
  const MethodSeries& chief = series.chief_method();
  const std::vector<std::size_t> all = frames_along_route(chief);
  const std::size_t stride = all.size() / kMostStrips + 1;
  std::vector<std::size_t> shown;
  for (std::size_t k = 0; k < all.size(); k += stride) shown.push_back(all[k]);
  std::vector<HoverStrip> strips;
  for (std::size_t k = 0; k < shown.size(); ++k) {
    const double here_m = chief.route_m[shown[k]];
    const double before_m = k > 0 ? chief.route_m[shown[k - 1]] : series.route_from_m;
    const double after_m = k + 1 < shown.size() ? chief.route_m[shown[k + 1]] : series.route_to_m;
    strips.push_back(
        {(before_m + here_m) / 2, (here_m + after_m) / 2, hover_text(series, shown[k])});
  }
  return strips;
}

// A lane a method; in it each stretch of frames with one status.
void add_status_lanes(Chart& chart, const ReportSeries& series) {
  for (const MethodSeries& method : series.methods) {
    chart.add_lane(method.css_class);
    const auto& fixes = method.evaluation->fixes;
    for (std::size_t first = 0; first < fixes.size();) {
      const FixStatus status = fixes[first].frame.fix.status;
      std::size_t end = first;
      double from_m = std::numeric_limits<double>::quiet_NaN();
      double to_m = from_m;
      for (; end < fixes.size() && fixes[end].frame.fix.status == status; ++end) {
        from_m = std::fmin(from_m, method.route_m[end]);
        to_m = std::fmax(to_m, method.route_m[end]);
      }
      if (const StatusMark* mark = mark_of(status)) {
        chart.mark_lane(from_m, to_m, mark->css_class,
                        method.name + ": " + mark->word + ", " + counted(end - first, "frame"));
      }
      first = end;
    }
  }
}

std::string status_legend() {
  std::string html = R"(<p class="legend">)";
  for (const StatusMark& mark : kStatusMarks) {
    html += std::string(R"(<span><svg width="18" height="8"><path class=")") + mark.css_class +
            R"(" d="M3 4H15"/></svg>)" + mark.word + "</span> ";
  }
  return html + "</p>\n";
}

std::string status_counts(const MethodSeries& method) {
  std::vector<std::string> parts;
  for (const FixStatus status : {FixStatus::tracking, FixStatus::predicted, FixStatus::initializing,
                                 FixStatus::lost, FixStatus::off_map}) {
    const auto& fixes = method.evaluation->fixes;
    const auto count = std::count_if(fixes.begin(), fixes.end(), [&](const EvaluatedFix& fix) {
      return fix.frame.fix.status == status;
    });
    if (count > 0) parts.push_back(std::to_string(count) + " " + word_of(status));
  }
  return listed(parts);
}

std::string beyond_text(const ReportSeries& series, const ErrorKind& kind, const Axis& y) {
  std::vector<std::string> parts;
  for (const MethodSeries& method : series.methods) {
    const std::vector<double>& errors_m = method.*kind.error_m;
    const auto beyond = std::count_if(errors_m.begin(), errors_m.end(), [&](double error_m) {
      return std::isfinite(error_m) && !y.contains(error_m);
    });
    if (beyond > 0) parts.push_back(std::to_string(beyond) + " of " + method.name);
  }
  if (parts.empty()) return "";
  return " Arrows at the edge stand for errors beyond " + plot::number(y.to(), y.ticks().decimals) +
         "\u00A0m: " + listed(parts) + ".";
}

std::string band_text(const MethodSeries& chief, double within_2_sigma) {
  return "The grey band is twice the standard deviation that " + chief.name +
         " itself reports: " + plot::number(100 * within_2_sigma, 1) +
         "\u00A0% of its errors lie inside; an honest one holds 95\u00A0%. ";
}

std::string error_caption(const ReportSeries& series, const Axis& y) {
  const MethodSeries& chief = series.chief_method();
  std::string text = "Above zero the fix is ahead of the truth, below it behind. ";
  if (chief.evaluation->summary.localized_frames > 0) {
    text += band_text(chief, chief.evaluation->summary.within_2_sigma);
  }
  text += "The lanes under the axis mark frames that were not tracked. " + chief.name + ": " +
          status_counts(chief) + ".";
  return text + beyond_text(series, kAlong, y) + unplaced_text(chief);
}

std::string lateral_caption(const ReportSeries& series, const Axis& y) {
  const MethodSeries& chief = series.chief_method();
  std::string text = "Above zero the fix is right of the truth, below it left. ";
  if (std::isfinite(chief.evaluation->summary.lateral_within_2_sigma)) {
    text += band_text(chief, chief.evaluation->summary.lateral_within_2_sigma);
  }
  return text + "Methods that know no lateral position are left out." +
         beyond_text(series, kLateral, y);
}

// A line a method, from zero up.
using FrameValue = double (*)(const EvaluatedFix&);

std::vector<Point> value_points(const MethodSeries& method, FrameValue value) {
  std::vector<Point> points;
  for (std::size_t i = 0; i < method.route_m.size(); ++i) {
    points.push_back({method.route_m[i], value(method.evaluation->fixes[i])});
  }
  return points;
}

std::vector<double> values_of(const MethodSeries& method, FrameValue value) {
  std::vector<double> values;
  for (const EvaluatedFix& fix : method.evaluation->fixes) values.push_back(value(fix));
  return values;
}

void draw_line_and_dots(Chart& chart, const std::vector<Point>& points, const MethodSeries& method,
                        const ReportSeries& series) {
  const bool is_chief = &method == &series.chief_method();
  const bool is_dense = points.size() > kMostInLine;
  if (!is_dense) chart.line(points, method.css_class + (is_chief ? " line chief" : " line"));
  chart.dots(points, method.css_class + (is_dense ? " dots fine" : " dots"));
  chart.arrows_beyond(points, method.css_class + " arrow");
}

Figure value_figure(const ReportSeries& series, const std::string& heading,
                    const std::string& y_label, int height_px, FrameValue value) {
  Figure figure;
  figure.heading = heading;
  figure.legend = method_legend(series);
  if (!has_route(series)) return figure;
  double reach = 0;
  for (const MethodSeries& method : series.methods) {
    reach = std::max(reach, robust_reach(values_of(method, value)));
  }
  Chart chart = Chart::of_height(
      route_axis(series), Axis::rounded(y_label, 0, reach > 0 ? reach : 1, 4), height_px, heading);
  for (const MethodSeries* method : series.back_to_front()) {
    draw_line_and_dots(chart, value_points(*method, value), *method, series);
  }
  figure.drawing = chart.svg();
  return figure;
}

double matches_of(const EvaluatedFix& fix) { return fix.frame.fix.matches; }
double latency_ms_of(const EvaluatedFix& fix) { return fix.frame.latency_ms; }

// Without the methods that compare whole images and match nothing; the chief stays.
ReportSeries matching_methods(const ReportSeries& all) {
  return only(all, [&](const MethodSeries& method) {
    const auto& fixes = method.evaluation->fixes;
    return &method == &all.chief_method() ||
           std::any_of(fixes.begin(), fixes.end(),
                       [](const EvaluatedFix& fix) { return matches_of(fix) > 0; });
  });
}

void draw_errors(Chart& chart, const ErrorKind& kind, const ReportSeries& series) {
  for (const MethodSeries* method : series.back_to_front()) {
    if (method == &series.chief_method()) chart.band(two_sigma_points(*method, kind), "band");
    draw_line_and_dots(chart, error_points(*method, kind), *method, series);
  }
}

}  // namespace

Figure error_figure(const ReportSeries& series) {
  Figure figure;
  figure.heading = "Error along the route";
  figure.legend = method_legend(series) + status_legend();
  const Axis y = Axis::rounded("error (m)", -series.error_limit_m, series.error_limit_m);
  figure.caption = error_caption(series, y);
  if (!has_route(series)) return figure;
  Chart chart =
      Chart::of_height(route_axis(series), y, 300, "Signed error of each frame along the route");
  draw_errors(chart, kAlong, series);
  add_status_lanes(chart, series);
  chart.hover(hover_strips(series));
  figure.drawing = chart.svg();
  return figure;
}

Figure lateral_figure(const ReportSeries& all) {
  const ReportSeries series =
      only(all, [](const MethodSeries& method) { return method.knows_lateral(); });
  Figure figure;
  figure.heading = "Error to the side";
  figure.legend = method_legend(series);
  const Axis y =
      Axis::rounded("lateral error (m)", -series.lateral_limit_m, series.lateral_limit_m);
  figure.caption = lateral_caption(series, y);
  if (!has_route(series)) return figure;
  Chart chart =
      Chart::of_height(route_axis(series), y, 220, "Signed lateral error along the route");
  draw_errors(chart, kLateral, series);
  chart.hover(hover_strips(series));
  figure.drawing = chart.svg();
  return figure;
}

Figure matches_figure(const ReportSeries& series) {
  Figure figure =
      value_figure(matching_methods(series), "Matches per frame", "matches", 160, matches_of);
  const MethodSeries& chief = series.chief_method();
  std::vector<double> matches = values_of(chief, matches_of);
  std::sort(matches.begin(), matches.end());
  figure.caption =
      "How many tracklets, or features, of the map agreed on the measurement of each frame; where "
      "there are few, the error above grows. " +
      chief.name + ": half of the frames have " + plot::number(quantile(matches, 0.5), 0) +
      " or more, one in twenty " + plot::number(quantile(matches, 0.05), 0) + " or fewer.";
  return figure;
}

Figure latency_figure(const ReportSeries& series) {
  Figure figure = value_figure(series, "Latency per frame", "latency (ms)", 120, latency_ms_of);
  const Summary& summary = series.chief_method().evaluation->summary;
  figure.caption = "From the decoded image to the fix. " + series.chief_method().name +
                   ": half of the frames take " + plot::number(summary.latency_ms_p50, 0) +
                   " ms or less, 99\u00A0% at most " + plot::number(summary.latency_ms_p99, 0) +
                   " ms.";
  return figure;
}

}  // namespace milepost
