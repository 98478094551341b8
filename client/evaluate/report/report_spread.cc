// How the errors spread: their histogram and their cumulative distribution.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "client/evaluate/report/report_figures.h"
#include "client/evaluate/report/report_numbers.h"

namespace milepost {
namespace {

constexpr int kPlotHeightPx = 250;
constexpr int kMostBins = 30;
constexpr int kFewestBins = 10;
constexpr double kMostScales = 8;  // finer bins than this would leave them empty
constexpr int kDensityPoints = 120;
constexpr int kCumulativePoints = 200;

// Bins of one width, as many on either side of zero.
struct Bins {
  double width_m = 0;
  int per_side = 0;
  int decimals = 0;

  double limit_m() const { return width_m * per_side; }
  int count() const { return 2 * per_side; }
  double from_m(int bin) const { return (bin - per_side) * width_m; }
};

// Fine enough for the reference method, whose errors may fill only a part of the common scale.
Bins common_bins(const ReportSeries& series) {
  const std::vector<double>& errors_m = series.reference_method().localized_errors_m;
  const int wanted =
      std::clamp(static_cast<int>(2 * std::sqrt(errors_m.size())), kFewestBins, kMostBins);
  const double reach_m =
      std::clamp(robust_reach(errors_m), series.error_limit_m / kMostScales, series.error_limit_m);
  const RoundStep step = round_step(2 * reach_m / wanted);
  const double per_side = std::ceil(series.error_limit_m / step.length - 1e-9);
  return {step.length, static_cast<int>(per_side), step.decimals};
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

// Where the steps of an outline begin: at each bin's left edge, from and to zero at the ends.
Json edges_m(const Bins& bins) {
  Json edges = Json::array({rounded(-bins.limit_m(), bins.decimals)});
  for (int bin = 0; bin <= bins.count(); ++bin) {
    edges.push_back(rounded(bins.from_m(bin), bins.decimals));
  }
  return edges;
}

Json outline_percent(const Histogram& histogram, const Bins& bins) {
  Json shares = Json::array({0});
  for (int bin = 0; bin < bins.count(); ++bin) {
    shares.push_back(rounded(histogram.share_percent(bin), 3));
  }
  shares.push_back(0);
  return shares;
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
Json density_layer(const Normal& normal, const Bins& bins) {
  Json x = Json::array();
  Json y = Json::array();
  const double peak = peak_percent(normal, bins);
  for (int i = 0; i <= kDensityPoints; ++i) {
    const double at_m = bins.limit_m() * (2.0 * i / kDensityPoints - 1);
    const double sigmas = (at_m - normal.mean_m) / normal.sigma_m;
    x.push_back(rounded(at_m, bins.decimals + 2));
    y.push_back(rounded(peak * std::exp(-sigmas * sigmas / 2), 3));
  }
  return {{"kind", "line"}, {"colour", "ink"}, {"width_px", 1}, {"x", x}, {"y", y}};
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
  const std::string limit = number(bins.limit_m(), bins.decimals) + "\u00A0m";
  const CutOff before = cut_off(series, bins, &Histogram::before);
  const CutOff beyond = cut_off(series, bins, &Histogram::beyond);
  if (before.total + beyond.total == 0) return " No error is left out.";
  std::vector<std::string> ends;
  if (before.total > 0) ends.push_back("below \u2212" + limit + " lie " + listed(before.parts));
  if (beyond.total > 0) ends.push_back("above " + limit + " lie " + listed(beyond.parts));
  return " Not drawn: " + (ends.size() == 2 ? ends[0] + "; " + ends[1] : ends[0]) + ".";
}

Json end_words(const ReportSeries& series, const Bins& bins, double top) {
  const std::size_t before = cut_off(series, bins, &Histogram::before).total;
  const std::size_t beyond = cut_off(series, bins, &Histogram::beyond).total;
  Json layers = Json::array();
  const auto add = [&](std::size_t count, const std::string& text, double at_m, const char* align,
                       int right_px) {
    if (count == 0) return;
    layers.push_back({{"kind", "texts"},
                      {"x", Json::array({rounded(at_m, bins.decimals)})},
                      {"y", Json::array({rounded(top, 3)})},
                      {"text", Json::array({text})},
                      {"align", align},
                      {"shift_px", {right_px, 14}}});
  };
  add(before, "\u25C2 " + std::to_string(before) + " further", -bins.limit_m(), "left", 4);
  add(beyond, std::to_string(beyond) + " further \u25B8", bins.limit_m(), "right", -4);
  return layers;
}

std::string histogram_caption(const ReportSeries& series, const Bins& bins, const Normal& normal) {
  const MethodSeries& reference = series.reference_method();
  std::string text = "Share of the localized frames in each bin of " +
                     number(bins.width_m, bins.decimals) + "\u00A0m.";
  if (can_show(normal, bins)) {
    text += " The thin line is a normal distribution with the mean (" +
            signed_number(normal.mean_m, 3) + "\u00A0m) and standard deviation (" +
            metres(normal.sigma_m) + ") of the errors of " + reference.name + " drawn here.";
  }
  return text + cut_off_text(series, bins);
}

std::vector<double> ascending_magnitudes(const MethodSeries& method) {
  std::vector<double> magnitudes;
  for (const double error_m : method.localized_errors_m) magnitudes.push_back(std::abs(error_m));
  std::sort(magnitudes.begin(), magnitudes.end());
  return magnitudes;
}

Json grid_m(double limit_m) {
  Json grid = Json::array();
  for (int i = 0; i <= kCumulativePoints; ++i) {
    grid.push_back(rounded(limit_m * i / kCumulativePoints, 5));
  }
  return grid;
}

// The share of magnitudes that are no larger, at each place of the grid.
Json shares_percent(const std::vector<double>& magnitudes, double limit_m) {
  Json shares = Json::array();
  for (int i = 0; i <= kCumulativePoints; ++i) {
    const auto end =
        std::upper_bound(magnitudes.begin(), magnitudes.end(), limit_m * i / kCumulativePoints);
    shares.push_back(rounded(100 * static_cast<double>(end - magnitudes.begin()) /
                                 static_cast<double>(magnitudes.size()),
                             2));
  }
  return shares;
}

Json level_layer(double percent, double limit_m) {
  return {{"kind", "line"},
          {"colour", "muted"},
          {"width_px", 1},
          {"dash", {2, 4}},
          {"x", {0, rounded(limit_m, 5)}},
          {"y", {percent, percent}}};
}

Json level_words(double limit_m) {
  return {{"kind", "texts"},  {"x", {rounded(limit_m, 5), rounded(limit_m, 5)}},
          {"y", {50, 95}},    {"text", {"50\u00A0%", "95\u00A0%"}},
          {"align", "right"}, {"shift_px", {-4, 14}}};
}

Json share_axis(double top_percent) {
  return axis("localized frames (%)", 0, rounded_up(top_percent, 5), 1);
}

Json share_layer(const MethodSeries& method, bool is_reference, const Json& x, const Json& y) {
  return {{"kind", "line"},
          {"name", method.name},
          {"colour", method.colour},
          {"width_px", is_reference ? 1.8 : 1.1},
          {"steps", true},
          {"total", method.localized_errors_m.size()},
          {"x", x},
          {"y", y}};
}

std::string cumulative_caption(const ReportSeries& series) {
  std::string text =
      "The share of the localized frames whose absolute error is at most that large; a better "
      "method rises earlier.";
  std::vector<std::string> others;
  for (const MethodSeries* method : series.back_to_front()) {
    if (method->localized_errors_m.empty()) continue;
    const Summary& summary = method->evaluation->summary;
    if (method == &series.reference_method()) {
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
  if (!has_errors(series)) return figure;
  const Bins bins = common_bins(series);
  const MethodSeries& reference = series.reference_method();
  const Normal normal = normal_of(reference.localized_errors_m, bins);
  figure.caption = histogram_caption(series, bins, normal);
  double top_percent = highest_percent(series, bins);
  if (can_show(normal, bins)) top_percent = std::max(top_percent, peak_percent(normal, bins));
  Json plot = {{"description", "Histogram of the signed errors"},
               {"height_px", kPlotHeightPx},
               {"bin", bins.width_m},
               {"x", axis("error (m)", -bins.limit_m(), bins.limit_m(), bins.decimals)},
               {"y", share_axis(top_percent)},
               {"layers", Json::array()}};
  for (const MethodSeries* method : series.back_to_front()) {
    if (method->localized_errors_m.empty()) continue;
    const Json shares = outline_percent(histogram_of(method->localized_errors_m, bins), bins);
    if (method == &reference) {
      plot["layers"].push_back({{"kind", "area"},
                                {"colour", method->colour},
                                {"opacity", 0.16},
                                {"steps", true},
                                {"x", edges_m(bins)},
                                {"y", shares}});
    }
    plot["layers"].push_back(share_layer(*method, method == &reference, edges_m(bins), shares));
  }
  if (can_show(normal, bins)) plot["layers"].push_back(density_layer(normal, bins));
  for (const Json& words : end_words(series, bins, plot["y"]["max"])) {
    plot["layers"].push_back(words);
  }
  figure.plots.push_back(plot);
  return figure;
}

Figure cumulative_figure(const ReportSeries& series) {
  Figure figure;
  figure.heading = "Frames within an error";
  if (!has_errors(series)) return figure;
  figure.caption = cumulative_caption(series);
  const double limit_m = rounded_up(series.error_limit_m, 5);
  Json plot = {{"description", "Cumulative distribution of the absolute error"},
               {"height_px", kPlotHeightPx},
               {"x", axis("absolute error (m)", 0, limit_m, 3)},
               {"y", share_axis(100)},
               {"layers", {level_layer(50, limit_m), level_layer(95, limit_m)}}};
  for (const MethodSeries* method : series.back_to_front()) {
    if (method->localized_errors_m.empty()) continue;
    plot["layers"].push_back(share_layer(*method, method == &series.reference_method(),
                                         grid_m(limit_m),
                                         shares_percent(ascending_magnitudes(*method), limit_m)));
  }
  plot["layers"].push_back(level_words(limit_m));
  figure.plots.push_back(plot);
  return figure;
}

}  // namespace milepost
