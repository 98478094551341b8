// Error distributions: the histogram and the cumulative distribution.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "client/evaluate/report/report_figures.h"
#include "client/evaluate/report/robust_reach.h"
#include "client/evaluate/statistics.h"
#include "schema/page/report_layers.h"
#include "schema/page/report_numbers.h"

namespace milepost {
namespace {

constexpr int kPlotHeightPx = 250;
constexpr int kMostBins = 30;
constexpr int kFewestBins = 10;
constexpr double kMostScales = 8;  // bounds the number of bins, most of which would be empty
constexpr int kDensityPoints = 120;
constexpr int kCumulativePoints = 200;

// Bins of equal width, as many on either side of zero.
struct Bins {
  double width_m = 0;
  int per_side = 0;
  int decimals = 0;

  double limit_m() const { return width_m * per_side; }
  int count() const { return 2 * per_side; }
  double from_m(int bin) const { return (bin - per_side) * width_m; }
};

// Bins fine enough for the reference method, whose errors may fill only a part of the common scale.
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
  std::vector<std::size_t> counts;  // one per bin
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

// The x coordinates of a histogram outline: the left edge of each bin, with zero at both ends.
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

// The normal distribution of the errors inside the bins: outliers are reported as text and would
// only widen the curve.
struct Normal {
  double mean_m = 0;
  double sigma_m = 0;
  double share = 0;  // of all errors
};

Normal normal_of(const std::vector<double>& errors_m, const Bins& bins) {
  std::vector<double> inside_m;
  std::copy_if(errors_m.begin(), errors_m.end(), std::back_inserter(inside_m),
               [&](double error_m) { return std::abs(error_m) <= bins.limit_m(); });
  return {mean_of(inside_m), deviation_of(inside_m),
          static_cast<double>(inside_m.size()) / static_cast<double>(errors_m.size())};
}

double peak_percent(const Normal& normal, const Bins& bins) {
  return 100 * normal.share * bins.width_m / (normal.sigma_m * std::sqrt(2 * std::numbers::pi));
}

// In percent of the frames per bin, like the histogram.
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
  return line_layer("", "ink", 1, x, y);
}

bool can_show(const Normal& normal, const Bins& bins) {
  // A narrower curve would not fit into the plot.
  return std::isfinite(normal.sigma_m) && normal.sigma_m > bins.width_m / 4;
}

bool has_errors(const ReportSeries& series) {
  return std::any_of(series.methods.begin(), series.methods.end(),
                     [](const MethodSeries& method) { return !method.localized_errors_m.empty(); });
}

using Histograms = std::vector<Histogram>;  // one per method

double highest_percent(const Histograms& histograms, const Bins& bins) {
  double highest = 0;
  for (const Histogram& histogram : histograms) {
    if (histogram.total == 0) continue;
    for (int bin = 0; bin < bins.count(); ++bin) {
      highest = std::max(highest, histogram.share_percent(bin));
    }
  }
  return highest;
}

// The number of errors cut off at one end of the plot, in total and per method: "2 of scale-only".
struct CutOff {
  std::size_t total = 0;
  std::vector<std::string> parts;
};

CutOff cut_off(const ReportSeries& series, const Histograms& histograms,
               std::size_t Histogram::*end) {
  CutOff cut;
  for (std::size_t i = 0; i < histograms.size(); ++i) {
    const std::size_t count = histograms[i].*end;
    cut.total += count;
    if (count > 0) cut.parts.push_back(std::to_string(count) + " of " + series.methods[i].name);
  }
  return cut;
}

std::string cut_off_text(const CutOff& before, const CutOff& beyond, const Bins& bins) {
  const std::string limit = number(bins.limit_m(), bins.decimals) + "\u00A0m";
  std::vector<std::string> ends;
  if (before.total > 0) ends.push_back("below \u2212" + limit + " lie " + listed(before.parts));
  if (beyond.total > 0) ends.push_back("above " + limit + " lie " + listed(beyond.parts));
  if (ends.empty()) return " No error is omitted.";
  return " Not drawn: " + (ends.size() == 2 ? ends[0] + "; " + ends[1] : ends[0]) + ".";
}

void add_end_words(Json& plot, const CutOff& before, const CutOff& beyond) {
  const auto add = [&](const std::string& text, const Json& x, const Words& words) {
    plot["layers"].push_back(
        texts_layer(Json::array({text}), words, Json::array({x}), Json::array({plot["y"]["max"]})));
  };
  if (before.total > 0) {
    add("\u25C2 " + std::to_string(before.total) + " further", plot["x"]["min"], {"left", 4, 14});
  }
  if (beyond.total > 0) {
    add(std::to_string(beyond.total) + " further \u25B8", plot["x"]["max"], {"right", -4, 14});
  }
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
  return text;
}

std::vector<double> ascending_magnitudes(const MethodSeries& method) {
  std::vector<double> magnitudes;
  for (const double error_m : method.localized_errors_m) magnitudes.push_back(std::abs(error_m));
  std::sort(magnitudes.begin(), magnitudes.end());
  return magnitudes;
}

Json steps_layer(const MethodSeries& method, bool is_reference, const Json& x, const Json& y) {
  Json layer = line_layer(method.name, method.colour, is_reference ? 1.8 : 1.1, x, y);
  layer["steps"] = true;
  layer["total"] = method.localized_errors_m.size();
  return layer;
}

// The cumulative share of the method's error magnitudes at positions common to all methods.
Json shares_layer(const MethodSeries& method, bool is_reference, double limit_m) {
  const std::vector<double> magnitudes = ascending_magnitudes(method);
  Json x = Json::array();
  Json y = Json::array();
  for (int i = 0; i <= kCumulativePoints; ++i) {
    const double at_m = limit_m * i / kCumulativePoints;
    const auto end = std::upper_bound(magnitudes.begin(), magnitudes.end(), at_m);
    x.push_back(rounded(at_m, 5));
    y.push_back(rounded(100 * static_cast<double>(end - magnitudes.begin()) /
                            static_cast<double>(magnitudes.size()),
                        2));
  }
  return steps_layer(method, is_reference, x, y);
}

Json level_layer(double percent, double limit_m) {
  Json level = line_layer("", "muted", 1, {0, rounded(limit_m, 5)}, {percent, percent});
  level["dash"] = {2, 4};
  return level;
}

Json share_axis(double top_percent) {
  return axis("localized frames (%)", 0, rounded_up(top_percent, 5), 1);
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
  Histograms histograms;
  for (const MethodSeries& method : series.methods) {
    histograms.push_back(histogram_of(method.localized_errors_m, bins));
  }
  const MethodSeries& reference = series.reference_method();
  const Normal normal = normal_of(reference.localized_errors_m, bins);
  const CutOff before = cut_off(series, histograms, &Histogram::before);
  const CutOff beyond = cut_off(series, histograms, &Histogram::beyond);
  figure.caption = histogram_caption(series, bins, normal) + cut_off_text(before, beyond, bins);
  double top_percent = highest_percent(histograms, bins);
  if (can_show(normal, bins)) top_percent = std::max(top_percent, peak_percent(normal, bins));
  Json plot = {{"description", "Histogram of the signed errors"},
               {"height_px", kPlotHeightPx},
               {"bin", bins.width_m},
               {"x", axis("error (m)", -bins.limit_m(), bins.limit_m(), bins.decimals)},
               {"y", share_axis(top_percent)},
               {"layers", Json::array()}};
  for (const MethodSeries* method : series.back_to_front()) {
    if (method->localized_errors_m.empty()) continue;
    const Json x = edges_m(bins);
    const Json y = outline_percent(histograms[method->number], bins);
    if (method == &reference) {
      Json area = area_layer("", method->colour, x, y);
      area["opacity"] = 0.16;
      area["steps"] = true;
      plot["layers"].push_back(area);
    }
    plot["layers"].push_back(steps_layer(*method, method == &reference, x, y));
  }
  if (can_show(normal, bins)) plot["layers"].push_back(density_layer(normal, bins));
  add_end_words(plot, before, beyond);
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
    plot["layers"].push_back(shares_layer(*method, method == &series.reference_method(), limit_m));
  }
  plot["layers"].push_back(texts_layer({"50\u00A0%", "95\u00A0%"}, {"right", -4, 14},
                                       {rounded(limit_m, 5), rounded(limit_m, 5)}, {50, 95}));
  figure.plots.push_back(plot);
  return figure;
}

}  // namespace milepost
