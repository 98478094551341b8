// Curves of the report of a found drive: errors and belief over time.
#include <algorithm>
#include <cmath>

#include "client/evaluate/report/find_report_figures.h"
#include "client/evaluate/report/find_status_marks.h"
#include "client/evaluate/report/plot/chart.h"
#include "client/evaluate/report/plot/text.h"
#include "client/evaluate/report/report_numbers.h"
#include "client/evaluate/statistics.h"

namespace milepost {
namespace {

using plot::Axis;
using plot::Chart;
using plot::HoverStrip;
using plot::Point;

constexpr std::size_t kMostStrips = 500;  // more would be narrower than a pointer can hit

Axis time_axis(const FoundSeries& series) {
  return Axis::spanning("time (s)", 0, series.time_s.back());
}

// Whole powers of ten about the values, of at least `least`.
Axis error_axis(const std::string& label, double least, std::vector<double> values) {
  values = finite_only(values);
  double low = 1;
  double high = 1;
  for (const double value : values) {
    low = std::min(low, std::max(least, value));
    high = std::max(high, value);
  }
  return Axis::logarithmic(label, std::pow(10, std::floor(std::log10(low))),
                           std::pow(10, std::ceil(std::log10(high))));
}

// What is smaller than the axis reaches lies on its edge.
std::vector<Point> points_of(const FoundSeries& series, const std::vector<double>& values,
                             double least) {
  std::vector<Point> points;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double value = values[i];
    points.push_back({series.time_s[i], std::isnan(value) ? value : std::max(least, value)});
  }
  return points;
}

template <class Value>
std::vector<double> values_of(const FoundSeries& series, const Value& value) {
  std::vector<double> values;
  for (const FoundFrame& frame : *series.input->frames) values.push_back(value(frame.fix));
  return values;
}

const FindStatusMark& mark_of(FindStatus status) {
  return *std::find_if(kFindStatusMarks.begin(), kFindStatusMarks.end() - 1,
                       [&](const FindStatusMark& mark) { return mark.status == status; });
}

// Each stretch of frames with one status.
void add_status_lane(Chart& chart, const FoundSeries& series) {
  const std::vector<FoundFrame>& frames = *series.input->frames;
  chart.add_lane("");
  for (std::size_t first = 0; first < frames.size();) {
    const FindStatus status = frames[first].fix.status;
    std::size_t end = first;
    while (end < frames.size() && frames[end].fix.status == status) ++end;
    const double to_s = series.time_s[std::min(end, frames.size() - 1)];
    chart.mark_lane(series.time_s[first], to_s, mark_of(status).lane_class,
                    std::string(name_of(status)) + ", " + counted(end - first, "frame"));
    first = end;
  }
}

std::string hover_text(const FoundSeries& series, std::size_t i) {
  const FoundFrame& frame = (*series.input->frames)[i];
  const FindFix& fix = frame.fix;
  return frame.filename + ", " + plot::number(series.time_s[i], 1) + " s: " + name_of(fix.status) +
         "\nposition off by " + plot::number(series.errors[i].position_m, 2) + " m (\u03C3 " +
         plot::number(fix.sigma_m, 2) + " m)\nheading off by " +
         plot::signed_number(series.errors[i].heading_deg, 1) + "\u00B0 (\u03C3 " +
         plot::number(fix.heading_sigma_deg, 1) + "\u00B0)\nmass " + plot::number(fix.mass, 2) +
         ", explained " + plot::number(fix.explained, 2);
}

// Each strip reaches half way to its neighbours.
std::vector<HoverStrip> hover_strips(const FoundSeries& series) {
  const std::size_t stride = series.time_s.size() / kMostStrips + 1;
  std::vector<HoverStrip> strips;
  double from_s = 0;
  for (std::size_t i = 0; i < series.time_s.size(); i += stride) {
    const std::size_t next = std::min(i + stride, series.time_s.size() - 1);
    const double to_s = (series.time_s[i] + series.time_s[next]) / 2;
    strips.push_back({from_s, to_s, hover_text(series, i)});
    from_s = to_s;
  }
  return strips;
}

std::string key(const std::string& css_class, const std::string& words) {
  return "<span class=\"" + css_class + "\"><i></i>" + words + "</span> ";
}

std::string legend(const std::string& keys) { return R"(<p class="legend">)" + keys + "</p>\n"; }

std::string status_legend() {
  std::string keys;
  for (const FindStatusMark& mark : kFindStatusMarks) {
    keys += std::string(R"(<span><svg width="18" height="8"><path class=")") + mark.lane_class +
            R"(" d="M3 4H15"/></svg>)" + name_of(mark.status) + "</span> ";
  }
  return legend(keys);
}

void draw_found_line(Chart& chart, const FoundSeries& series, const Axis& y) {
  if (!series.summary.found_frame) return;
  const double at_s = series.time_s[*series.summary.found_frame];
  chart.line({{at_s, y.from()}, {at_s, y.to()}}, "moment");
  chart.word({at_s, y.to()}, 5, 13, "strong", "found");
}

struct ErrorCurve {
  std::string heading;
  std::string label;
  int height_px = 0;
  double least = 0;  // drawn to scale
  std::vector<double> errors;
  std::vector<double> two_sigmas;
};

Figure error_figure(const FoundSeries& series, const ErrorCurve& curve) {
  Figure figure;
  figure.heading = curve.heading;
  figure.legend =
      legend(key("m0", "error") + key("swatch", "up to 2\u03C3 as reported")) + status_legend();
  if (finite_only(curve.errors).empty()) return figure;
  std::vector<double> all = curve.errors;
  all.insert(all.end(), curve.two_sigmas.begin(), curve.two_sigmas.end());
  const Axis y = error_axis(curve.label, curve.least, all);
  Chart chart = Chart::of_height(time_axis(series), y, curve.height_px, curve.heading);
  chart.area(points_of(series, curve.two_sigmas, y.from()), "band");
  chart.line(points_of(series, curve.errors, y.from()), "m0 line chief");
  draw_found_line(chart, series, y);
  add_status_lane(chart, series);
  chart.hover(hover_strips(series));
  figure.drawing = chart.svg();
  return figure;
}

}  // namespace

Figure position_error_figure(const FoundSeries& series) {
  ErrorCurve curve{"Position error over time", "error (m)", 260, 0.1, {}, {}};
  for (const FindError& error : series.errors) curve.errors.push_back(error.position_m);
  curve.two_sigmas = values_of(series, [](const FindFix& fix) { return 2 * fix.sigma_m; });
  Figure figure = error_figure(series, curve);
  figure.caption =
      "Distance from the recorded position, on a logarithmic scale, so that both the search and "
      "the tracking can be read. In the grey the error is within twice the reported \u03C3, which "
      "is that of the whole belief while nothing is found. The lane under the axis shows the "
      "status of each frame.";
  return figure;
}

Figure heading_error_figure(const FoundSeries& series) {
  ErrorCurve curve{"Heading error over time", "error (\u00B0)", 180, 0.1, {}, {}};
  for (const FindError& error : series.errors) curve.errors.push_back(std::abs(error.heading_deg));
  curve.two_sigmas =
      values_of(series, [](const FindFix& fix) { return 2 * fix.heading_sigma_deg; });
  Figure figure = error_figure(series, curve);
  figure.caption = "Absolute angle to the recorded heading; \u03C3 is that of the densest place.";
  return figure;
}

Figure belief_figure(const FoundSeries& series) {
  Figure figure;
  figure.heading = "What the belief rests on";
  figure.legend = legend(key("m0", "mass of the densest place") + key("m1", "explained share")) +
                  status_legend();
  figure.caption =
      "Mass: the part of the belief that lies in the densest place. Explained: the share of what "
      "was seen lately that the walls there explain. A vehicle counts as found when both are high "
      "for some way, and as lost when one falls low.";
  const Axis y = Axis::spanning("share", 0, 1, 5);
  Chart chart = Chart::of_height(time_axis(series), y, 160, figure.heading);
  const auto draw = [&](const std::vector<double>& values, const std::string& css_class) {
    chart.line(points_of(series, values, 0), css_class);
  };
  draw(values_of(series, [](const FindFix& fix) { return fix.explained; }), "m1 line");
  draw(values_of(series, [](const FindFix& fix) { return fix.mass; }), "m0 line chief");
  draw_found_line(chart, series, y);
  add_status_lane(chart, series);
  figure.drawing = chart.svg();
  return figure;
}

}  // namespace milepost
