#include "mapper/report/histogram.h"

#include <algorithm>
#include <cmath>

#include "schema/page/report_layers.h"
#include "schema/page/report_numbers.h"

namespace milepost {
namespace {

constexpr int kPlotHeightPx = 170;
constexpr int kWantedBins = 24;
constexpr double kUsualShare = 0.99;  // of the values that the bins are to hold

struct Bins {
  double width = 1;
  int decimals = 0;
  int count = 1;
  double from = 0;
};

double quantile_of(std::vector<double> values, double share) {
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

Bins bins_for(const HistogramAxis& axis, const std::vector<HistogramValues>& sets) {
  double reach = 0;
  for (const HistogramValues& set : sets) {
    if (!set.values.empty()) reach = std::max(reach, quantile_of(set.values, kUsualShare));
  }
  if (axis.is_whole) return {1, 0, std::clamp(static_cast<int>(reach), 4, kWantedBins), 0.5};
  const RoundStep step = round_step(reach > 0 ? reach / kWantedBins : 1);
  return {step.length, step.decimals,
          std::max(1, static_cast<int>(std::floor(reach / step.length)) + 1), 0};
}

std::vector<double> shares_percent(const std::vector<double>& values, const Bins& bins) {
  std::vector<double> shares(static_cast<std::size_t>(bins.count), 0);
  for (const double value : values) {
    const double bin = std::floor((value - bins.from) / bins.width);
    const double last = bins.count - 1;
    shares[static_cast<std::size_t>(std::clamp(bin, 0.0, last))] +=
        100 / static_cast<double>(values.size());
  }
  return shares;
}

// The outline, with zero at both ends.
Json outline(const HistogramValues& set, const Bins& bins) {
  Json x = Json::array({rounded(bins.from, bins.decimals + 1)});
  Json y = Json::array({0});
  const std::vector<double> shares = shares_percent(set.values, bins);
  for (int bin = 0; bin <= bins.count; ++bin) {
    x.push_back(rounded(bins.from + bin * bins.width, bins.decimals + 1));
    y.push_back(bin == bins.count ? Json(0) : rounded(shares[static_cast<std::size_t>(bin)], 2));
  }
  Json layer = area_layer(set.name, set.colour, x, y);
  layer["opacity"] = 0.55;
  layer["steps"] = true;
  layer["total"] = set.values.size();
  return layer;
}

}  // namespace

Figure histogram_figure(const std::string& heading, const std::string& caption,
                        const HistogramAxis& of, const std::vector<HistogramValues>& sets) {
  Figure figure{heading, caption};
  std::vector<HistogramValues> filled;
  std::ranges::copy_if(sets, std::back_inserter(filled),
                       [](const HistogramValues& set) { return !set.values.empty(); });
  if (filled.empty()) return figure;
  const Bins bins = bins_for(of, filled);
  double highest = 0;
  Json layers = Json::array();
  for (const HistogramValues& set : filled) {
    highest = std::max(highest, std::ranges::max(shares_percent(set.values, bins)));
    layers.push_back(outline(set, bins));
  }
  Json plot = {{"description", heading},
               {"height_px", kPlotHeightPx},
               {"x", axis(of.label, bins.from, bins.from + bins.count * bins.width,
                          of.is_whole ? 0 : bins.decimals)},
               {"y", axis("% of the " + of.of, 0, rounded_up(highest * 1.05, 4), 1)},
               {"bin", bins.width},
               {"legend", filled.size() > 1},
               {"layers", layers}};
  figure.plots.push_back(plot);
  return figure;
}

}  // namespace milepost
