// How the errors spread: their histogram and their cumulative distribution.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "client/evaluate/report/plot/chart.h"
#include "client/evaluate/report/plot/text.h"
#include "client/evaluate/report/report_figures.h"
#include "client/evaluate/report/report_numbers.h"

namespace milepost {
namespace {

using plot::Axis;
using plot::Chart;
using plot::HoverStrip;
using plot::Point;

constexpr int kPlotHeightPx = 250;
constexpr int kMostBins = 30;
constexpr int kFewestBins = 10;
constexpr double kMostScales = 8;  // finer bins than this would leave them empty
constexpr int kDensityPoints = 240;

// Bins of one width, as many on either side of zero.
struct Bins {
  double width_m = 0;
  int per_side = 0;
  int decimals = 0;

  double limit_m() const { return width_m * per_side; }
  int count() const { return 2 * per_side; }
  double from_m(int bin) const { return (bin - per_side) * width_m; }
};

// Fine enough for the chief method, whose errors may fill only a part of the common scale.
Bins common_bins(const ReportSeries& series) {
  const std::vector<double>& errors_m = series.chief_method().localized_errors_m;
  const int wanted =
      std::clamp(static_cast<int>(2 * std::sqrt(errors_m.size())), kFewestBins, kMostBins);
  const double reach_m =
      std::clamp(robust_reach(errors_m), series.error_limit_m / kMostScales, series.error_limit_m);
  const plot::Ticks ticks = plot::round_ticks(-reach_m, reach_m, wanted);
  const double per_side = std::ceil(series.error_limit_m / ticks.step - 1e-9);
  return {ticks.step, static_cast<int>(per_side), ticks.decimals};
}

struct Histogram {
  std::vector<std::size_t> counts;  // one a bin
  std::size_t before = 0;           // below the first bin
  std::size_t beyond = 0;           // above the last one
  double total = 0;                 // all of them

  double share_percent(int bin) const {
    return 100 * static_cast<double>(counts[static_cast<std::size_t>(bin)]) / total;
  }
};

Histogram histogram_of(const std::vector<double>& errors_m, const Bins& bins) {
  Histogram histogram;
  histogram.counts.resize(static_cast<std::size_t>(bins.count()));
  histogram.total = static_cast<double>(errors_m.size());
  for (const double error_m : errors_m) {
    if (error_m < -bins.limit_m()) {
      ++histogram.before;
    } else if (error_m > bins.limit_m()) {
      ++histogram.beyond;
    } else {
      const int bin = static_cast<int>(std::floor(error_m / bins.width_m)) + bins.per_side;
      ++histogram.counts[static_cast<std::size_t>(std::clamp(bin, 0, bins.count() - 1))];
    }
  }
  return histogram;
}

std::vector<Point> outline(const Histogram& histogram, const Bins& bins) {
  std::vector<Point> points = {{-bins.limit_m(), 0}};
  for (int bin = 0; bin < bins.count(); ++bin) {
    points.push_back({bins.from_m(bin), histogram.share_percent(bin)});
    points.push_back({bins.from_m(bin + 1), histogram.share_percent(bin)});
  }
  points.push_back({bins.limit_m(), 0});
  return points;
}

// Of the errors inside the bins: those beyond are said in words and would only widen the curve.
struct Normal {
  double mean_m = 0;
  double sigma_m = 0;
  double share = 0;  // of all errors
};

Normal normal_of(const std::vector<double>& errors_m, const Bins& bins) {
  double sum = 0;
  double squares = 0;
  double count = 0;
  for (const double error_m : errors_m) {
    if (std::abs(error_m) > bins.limit_m()) continue;
    sum += error_m;
    squares += error_m * error_m;
    ++count;
  }
  const double mean_m = sum / count;
  return {mean_m, std::sqrt(std::max(0.0, squares / count - mean_m * mean_m)),
          count / static_cast<double>(errors_m.size())};
}

double peak_percent(const Normal& normal, const Bins& bins) {
  return 100 * normal.share * bins.width_m / (normal.sigma_m * std::sqrt(2 * std::numbers::pi));
}

// In percent of the frames a bin, like the histogram.
std::vector<Point> density_points(const Normal& normal, const Bins& bins) {
  std::vector<Point> points;
  const double peak = peak_percent(normal, bins);
  for (int i = 0; i <= kDensityPoints; ++i) {
    const double at_m = bins.limit_m() * (2.0 * i / kDensityPoints - 1);
    const double sigmas = (at_m - normal.mean_m) / normal.sigma_m;
    points.push_back({at_m, peak * std::exp(-sigmas * sigmas / 2)});
  }
  return points;
}

bool can_show(const Normal& normal, const Bins& bins) {
  // Narrower than this the curve would leave the plot as a needle.
  return std::isfinite(normal.sigma_m) && normal.sigma_m > bins.width_m / 4;
}

bool has_errors(const ReportSeries& series) {
  return std::any_of(series.methods.begin(), series.methods.end(),
                     [](const MethodSeries& method) { return !method.localized_errors_m.empty(); });
}

double highest_percent(const ReportSeries& series, const Bins& bins) {
  double highest = 0;
  for (const MethodSeries& method : series.methods) {
    if (method.localized_errors_m.empty()) continue;
    const Histogram histogram = histogram_of(method.localized_errors_m, bins);
    for (int bin = 0; bin < bins.count(); ++bin) {
      highest = std::max(highest, histogram.share_percent(bin));
    }
  }
  return highest;
}

std::vector<HoverStrip> bin_strips(const ReportSeries& series, const Bins& bins) {
  std::vector<HoverStrip> strips;
  for (int bin = 0; bin < bins.count(); ++bin) {
    std::string text = plot::number(bins.from_m(bin), bins.decimals) + " to " +
                       plot::number(bins.from_m(bin + 1), bins.decimals) + " m";
    for (const MethodSeries& method : series.methods) {
      const Histogram histogram = histogram_of(method.localized_errors_m, bins);
      text += "\n" + method.name + ": " +
              counted(histogram.counts[static_cast<std::size_t>(bin)], "frame");
    }
    strips.push_back({bins.from_m(bin), bins.from_m(bin + 1), text});
  }
  return strips;
}

// "2 of scale-only": how many errors of each method one end of the plot cut off.
struct CutOff {
  std::size_t total = 0;
  std::vector<std::string> parts;
};

CutOff cut_off(const ReportSeries& series, const Bins& bins, std::size_t Histogram::*end) {
  CutOff cut;
  for (const MethodSeries& method : series.methods) {
    const std::size_t count = histogram_of(method.localized_errors_m, bins).*end;
    cut.total += count;
    if (count > 0) cut.parts.push_back(std::to_string(count) + " of " + method.name);
  }
  return cut;
}

std::string cut_off_text(const ReportSeries& series, const Bins& bins) {
  const std::string limit = plot::number(bins.limit_m(), bins.decimals) + "\u00A0m";
  const CutOff before = cut_off(series, bins, &Histogram::before);
  const CutOff beyond = cut_off(series, bins, &Histogram::beyond);
  if (before.total + beyond.total == 0) return " No error is left out.";
  std::vector<std::string> ends;
  if (before.total > 0) ends.push_back("below \u2212" + limit + " lie " + listed(before.parts));
  if (beyond.total > 0) ends.push_back("above " + limit + " lie " + listed(beyond.parts));
  return " Not drawn: " + (ends.size() == 2 ? ends[0] + "; " + ends[1] : ends[0]) + ".";
}

void add_end_words(Chart& chart, const ReportSeries& series, const Bins& bins, double top) {
  const std::size_t before = cut_off(series, bins, &Histogram::before).total;
  const std::size_t beyond = cut_off(series, bins, &Histogram::beyond).total;
  if (before > 0) {
    chart.word({-bins.limit_m(), top}, 4, 14, "", "\u25C2 " + std::to_string(before) + " further");
  }
  if (beyond > 0) {
    chart.word({bins.limit_m(), top}, -4, 14, "end", std::to_string(beyond) + " further \u25B8");
  }
}

std::string histogram_caption(const ReportSeries& series, const Bins& bins, const Normal& normal) {
  const MethodSeries& chief = series.chief_method();
  std::string text = "Share of the localized frames in each bin of " +
                     plot::number(bins.width_m, bins.decimals) + "\u00A0m.";
  if (can_show(normal, bins)) {
    text += " The thin line is a normal distribution with the mean (" +
            plot::signed_number(normal.mean_m, 3) + "\u00A0m) and standard deviation (" +
            metres(normal.sigma_m) + ") of the errors of " + chief.name + " drawn here.";
  }
  return text + cut_off_text(series, bins);
}

std::vector<double> ascending_magnitudes(const MethodSeries& method) {
  std::vector<double> magnitudes;
  for (const double error_m : method.localized_errors_m) magnitudes.push_back(std::abs(error_m));
  std::sort(magnitudes.begin(), magnitudes.end());
  return magnitudes;
}

// Steps up by one frame's share at each error.
std::vector<Point> cumulative_points(const std::vector<double>& magnitudes, double limit_m) {
  std::vector<Point> points = {{0, 0}};
  const double each = 100 / static_cast<double>(magnitudes.size());
  for (std::size_t i = 0; i < magnitudes.size() && magnitudes[i] <= limit_m; ++i) {
    points.push_back({magnitudes[i], each * static_cast<double>(i)});
    points.push_back({magnitudes[i], each * static_cast<double>(i + 1)});
  }
  points.push_back({limit_m, points.back().y});
  return points;
}

std::string cumulative_caption(const ReportSeries& series) {
  std::string text =
      "The share of the localized frames whose absolute error is at most that large; a better "
      "method rises earlier.";
  std::vector<std::string> others;
  for (const MethodSeries* method : series.back_to_front()) {
    if (method->localized_errors_m.empty()) continue;
    const Summary& summary = method->evaluation->summary;
    if (method == &series.chief_method()) {
      text += " With " + method->name + " half of the frames are within " +
              metres(summary.p50_error_m) + ", 95\u00A0% within " + metres(summary.p95_error_m) +
              ".";
    } else {
      others.push_back(method->name + " " + metres(summary.p50_error_m) + " and " +
                       metres(summary.p95_error_m));
    }
  }
  if (others.empty()) return text;
  text += " The same two figures of the others:";
  for (const std::string& other : others) text += (&other == others.data() ? " " : "; ") + other;
  return text + ".";
}

}  // namespace

Figure histogram_figure(const ReportSeries& series) {
  Figure figure;
  figure.heading = "Errors by size";
  figure.legend = method_legend(series);
  if (!has_errors(series)) return figure;
  const Bins bins = common_bins(series);
  const MethodSeries& chief = series.chief_method();
  const Normal normal = normal_of(chief.localized_errors_m, bins);
  figure.caption = histogram_caption(series, bins, normal);
  double top_percent = highest_percent(series, bins);
  if (can_show(normal, bins)) top_percent = std::max(top_percent, peak_percent(normal, bins));
  const Axis y = Axis::rounded("localized frames (%)", 0, top_percent, 5);
  Chart chart = Chart::of_height(Axis::spanning("error (m)", -bins.limit_m(), bins.limit_m(), 6), y,
                                 kPlotHeightPx, "Histogram of the signed errors");
  for (const MethodSeries* method : series.back_to_front()) {
    if (method->localized_errors_m.empty()) continue;
    const std::vector<Point> steps = outline(histogram_of(method->localized_errors_m, bins), bins);
    if (method == &chief) chart.area(steps, method->css_class + " area");
    chart.line(steps, method->css_class + (method == &chief ? " line chief" : " line"));
  }
  if (can_show(normal, bins)) chart.line(density_points(normal, bins), "density");
  add_end_words(chart, series, bins, y.to());
  chart.hover(bin_strips(series, bins));
  figure.drawing = chart.svg();
  return figure;
}

Figure cumulative_figure(const ReportSeries& series) {
  Figure figure;
  figure.heading = "Frames within an error";
  figure.legend = method_legend(series);
  if (!has_errors(series)) return figure;
  figure.caption = cumulative_caption(series);
  const Axis x = Axis::rounded("absolute error (m)", 0, series.error_limit_m);
  Chart chart = Chart::of_height(x, Axis::spanning("localized frames (%)", 0, 100, 5),
                                 kPlotHeightPx, "Cumulative distribution of the absolute error");
  chart.level(50, "level", "50\u00A0%");
  chart.level(95, "level", "95\u00A0%");
  for (const MethodSeries* method : series.back_to_front()) {
    if (method->localized_errors_m.empty()) continue;
    chart.line(cumulative_points(ascending_magnitudes(*method), x.to()),
               method->css_class + (method == &series.chief_method() ? " line chief" : " line"));
  }
  figure.drawing = chart.svg();
  return figure;
}

}  // namespace milepost
