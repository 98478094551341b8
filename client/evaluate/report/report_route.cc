// Figures along the route: errors, matches and latency, frame by frame.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "client/evaluate/report/report_figures.h"
#include "client/evaluate/report/robust_reach.h"
#include "client/evaluate/statistics.h"
#include "schema/page/report_layers.h"
#include "schema/page/report_numbers.h"

namespace milepost {
namespace {

constexpr int kMostInLine = 600;  // points; a line through more is not readable

// Tracking is the normal case and has no mark.
constexpr std::array<FixStatus, 4> kMarked = {FixStatus::initializing, FixStatus::predicted,
                                              FixStatus::lost, FixStatus::off_map};

bool is_marked(FixStatus status) {
  return std::find(kMarked.begin(), kMarked.end(), status) != kMarked.end();
}

using FixSigma = double (*)(const Fix&);  // NaN if none is reported

double along_sigma_m(const Fix& fix) { return fix.along_m ? fix.sigma_m : kNaN; }
double along_sigma_map_m(const Fix& fix) { return fix.along_m ? fix.sigma_map_m : kNaN; }
double lateral_sigma_m(const Fix& fix) { return fix.lateral_sigma_m.value_or(kNaN); }
// The map is as exact across as along.
double lateral_sigma_map_m(const Fix& fix) {
  const double lateral_m = lateral_sigma_m(fix);
  const double of_map_m2 = fix.sigma_m * fix.sigma_m - fix.sigma_map_m * fix.sigma_map_m;
  return std::isnan(lateral_m) ? kNaN : std::sqrt(std::max(0.0, lateral_m * lateral_m - of_map_m2));
}

// A kind of signed errors along the route, and the reported sigmas.
struct ErrorKind {
  std::vector<double> MethodSeries::*error_m;
  const char* error_column;
  FixSigma sigma_m;      // in the world
  FixSigma sigma_map_m;  // against the map
};

constexpr ErrorKind kAlong = {&MethodSeries::error_m, "error_m", along_sigma_m, along_sigma_map_m};
constexpr ErrorKind kLateral = {&MethodSeries::lateral_error_m, "lateral_error_m", lateral_sigma_m,
                                lateral_sigma_map_m};

std::vector<double> two_sigmas_m(const MethodSeries& method, FixSigma sigma_m) {
  std::vector<double> values;
  for (const EvaluatedFix& fix : method.evaluation->fixes)
    values.push_back(2 * sigma_m(fix.frame.fix));
  return values;
}

// Half the height of a plot of errors: as far as they reach, and the usual band of the reference
// method, unless that makes them too small to see.
double error_axis_m(const ReportSeries& series, const ErrorKind& kind, double errors_reach_m) {
  constexpr double kMostTimes = 4;
  std::vector<double> band_m =
      finite_only(two_sigmas_m(series.reference_method(), kind.sigma_map_m));
  std::ranges::sort(band_m);
  const double usual_m = band_m.empty() ? 0 : quantile(band_m, 0.75);
  return rounded_up(std::clamp(usual_m, errors_reach_m, kMostTimes * errors_reach_m), 3);
}

// Of the errors that have a sigma.
double share_within(const std::vector<double>& errors_m, const std::vector<double>& bounds_m) {
  double within = 0;
  double count = 0;
  for (std::size_t i = 0; i < errors_m.size(); ++i) {
    if (std::isnan(errors_m[i]) || std::isnan(bounds_m[i])) continue;
    within += std::abs(errors_m[i]) <= bounds_m[i] ? 1 : 0;
    ++count;
  }
  return within / count;
}

// A plot over frames without layers.
Json route_plot(const ReportSeries& series, const std::string& description, int height_px,
                const Json& y) {
  Json x = axis(series.route_label + " (m)", series.route_from_m, series.route_to_m);
  if (series.route_from_m == series.route_to_m) {  // an axis needs a length
    x["min"] = rounded(series.route_from_m - 1, 3);
    x["max"] = rounded(series.route_to_m + 1, 3);
  }
  return {{"frames", true}, {"description", description}, {"height_px", height_px}, {"x", x},
          {"y", y},         {"layers", Json::array()}};
}

// A line, unless it would be too dense, with a dot per frame.
void add_values(Json& plot, const MethodSeries& method, const char* column, bool is_reference) {
  const std::string y = method.column(column);
  Json line = line_layer(method.name, method.colour, is_reference ? 1.8 : 1.1, "route_m", y);
  line["most_points"] = kMostInLine;
  Json dots = dots_layer("", method.colour, 1.6, "route_m", y);
  dots["arrows"] = true;
  plot["layers"].push_back(line);
  plot["layers"].push_back(dots);
}

std::string unplaced_text(const ReportSeries& series) {
  const auto unplaced = static_cast<std::size_t>(std::count_if(
      series.route_m.begin(), series.route_m.end(), [](double at_m) { return std::isnan(at_m); }));
  if (unplaced == 0) return "";
  return " Not drawn: " + counted(unplaced, "frame") + " without a true position.";
}

// One lane per method with each run of frames of one status: [from, to, status].
Json status_lanes(const ReportSeries& series) {
  Json lanes = Json::array();
  for (const MethodSeries& method : series.methods) {
    Json marks = Json::array();
    const auto& fixes = method.evaluation->fixes;
    for (std::size_t first = 0; first < fixes.size();) {
      const FixStatus status = fixes[first].frame.fix.status;
      std::size_t end = first;
      double from_m = kNaN;
      double to_m = kNaN;
      for (; end < fixes.size() && fixes[end].frame.fix.status == status; ++end) {
        from_m = std::fmin(from_m, series.route_m[end]);
        to_m = std::fmax(to_m, series.route_m[end]);
      }
      if (is_marked(status) && std::isfinite(from_m)) {
        marks.push_back(Json::array({rounded(from_m, 3), rounded(to_m, 3), name_of(status)}));
      }
      first = end;
    }
    lanes.push_back({{"colour", method.colour}, {"marks", marks}});
  }
  return lanes;
}

std::string status_counts(const MethodSeries& method) {
  std::vector<std::string> parts;
  for (const FixStatus status : {FixStatus::tracking, FixStatus::predicted, FixStatus::initializing,
                                 FixStatus::lost, FixStatus::off_map}) {
    const auto& fixes = method.evaluation->fixes;
    const auto count = std::count_if(fixes.begin(), fixes.end(), [&](const EvaluatedFix& fix) {
      return fix.frame.fix.status == status;
    });
    if (count > 0) parts.push_back(std::to_string(count) + " " + name_of(status));
  }
  return listed(parts);
}

std::string beyond_text(const ReportSeries& series, const ErrorKind& kind, double limit_m) {
  std::vector<std::string> parts;
  for (const MethodSeries& method : series.methods) {
    const std::vector<double>& errors_m = method.*kind.error_m;
    const auto beyond = std::count_if(errors_m.begin(), errors_m.end(), [&](double error_m) {
      return std::isfinite(error_m) && std::abs(error_m) > limit_m;
    });
    if (beyond > 0) parts.push_back(std::to_string(beyond) + " of " + method.name);
  }
  if (parts.empty()) return "";
  return " Arrows at the edge stand for errors beyond " + metres(limit_m) + ": " + listed(parts) +
         ".";
}

std::string band_text(const MethodSeries& reference, const ErrorKind& kind) {
  const std::vector<double>& errors_m = reference.*kind.error_m;
  const auto inside = [&](FixSigma sigma_m) {
    return number(100 * share_within(errors_m, two_sigmas_m(reference, sigma_m)), 1) + "\u00A0%";
  };
  return "The grey bands are twice the standard deviations that " + reference.name +
         " reports: the wide one in the world, with what the map knows of its own error (" +
         inside(kind.sigma_m) + " of the errors lie inside), the dark one against the map (" +
         inside(kind.sigma_map_m) + "). For a consistent estimate 95\u00A0% do. ";
}

std::string error_caption(const ReportSeries& series, double limit_m) {
  const MethodSeries& reference = series.reference_method();
  std::string text = "Above zero the fix is ahead of the truth, below it behind. ";
  if (reference.evaluation->summary.localized_frames > 0) text += band_text(reference, kAlong);
  text += "The lanes under the axis mark frames that were not tracked. " + reference.name + ": " +
          status_counts(reference) + ".";
  return text + beyond_text(series, kAlong, limit_m) + unplaced_text(series);
}

std::string lateral_caption(const ReportSeries& series, double limit_m) {
  const MethodSeries& reference = series.reference_method();
  std::string text = "Above zero the fix is right of the truth, below it left. ";
  if (std::isfinite(reference.evaluation->summary.lateral_within_2_sigma))
    text += band_text(reference, kLateral);
  return text + "Methods that do not estimate a lateral offset are omitted." +
         beyond_text(series, kLateral, limit_m);
}

void add_band(Json& plot, const std::string& name, const char* colour,
              const std::vector<double>& bounds_m) {
  Json band = area_layer(name, colour, "route_m", rounded(bounds_m, 4));
  band["kind"] = "band";
  plot["layers"].push_back(band);
}

// The errors of all methods over the bands of the reference method.
void add_errors(Json& plot, const ReportSeries& series, const ErrorKind& kind) {
  for (const MethodSeries* method : series.back_to_front()) {
    const bool is_reference = method == &series.reference_method();
    if (is_reference) {
      add_band(plot, "2\u03C3 of " + method->name + " in the world", "band",
               two_sigmas_m(*method, kind.sigma_m));
      add_band(plot, "2\u03C3 against the map", "map-band",
               two_sigmas_m(*method, kind.sigma_map_m));
    }
    add_values(plot, *method, kind.error_column, is_reference);
  }
}

using FrameValue = double (*)(const EvaluatedFix&);

std::vector<double> values_of(const MethodSeries& method, FrameValue value) {
  std::vector<double> values;
  for (const EvaluatedFix& fix : method.evaluation->fixes) values.push_back(value(fix));
  return values;
}

double matches_of(const EvaluatedFix& fix) { return fix.frame.fix.matches; }
double latency_ms_of(const EvaluatedFix& fix) { return fix.frame.latency_ms; }

struct ValueKind {
  const char* heading;
  const char* y_label;
  const char* column;
  int height_px;
  FrameValue value;
};

// One line per method, from zero up.
Figure value_figure(const ReportSeries& series, const ValueKind& kind) {
  Figure figure;
  figure.heading = kind.heading;
  if (!series.has_route()) return figure;
  double reach = 0;
  for (const MethodSeries& method : series.methods) {
    reach = std::max(reach, robust_reach(values_of(method, kind.value)));
  }
  Json plot =
      route_plot(series, kind.heading, kind.height_px, axis(kind.y_label, 0, rounded_up(reach, 4)));
  for (const MethodSeries* method : series.back_to_front()) {
    add_values(plot, *method, kind.column, method == &series.reference_method());
  }
  figure.plots.push_back(plot);
  return figure;
}

// Without the methods that compare whole images and have no matches; the reference method stays.
ReportSeries matching_methods(const ReportSeries& all) {
  return only(all, [&](const MethodSeries& method) {
    const auto& fixes = method.evaluation->fixes;
    return &method == &all.reference_method() ||
           std::any_of(fixes.begin(), fixes.end(),
                       [](const EvaluatedFix& fix) { return matches_of(fix) > 0; });
  });
}

}  // namespace

Figure error_figure(const ReportSeries& series) {
  Figure figure;
  figure.heading = "Error along the route";
  const double limit_m = error_axis_m(series, kAlong, series.error_limit_m);
  figure.caption = error_caption(series, limit_m);
  if (!series.has_route()) return figure;
  Json plot = route_plot(series, "Signed error of each frame along the route", 300,
                         axis("arc length error (m)", -limit_m, limit_m, 3));
  add_errors(plot, series, kAlong);
  plot["lanes"] = status_lanes(series);
  figure.plots.push_back(plot);
  for (const FixStatus status : kMarked) figure.keys.push_back(status_key(name_of(status)));
  return figure;
}

Figure lateral_figure(const ReportSeries& all) {
  const ReportSeries series =
      only(all, [](const MethodSeries& method) { return method.knows_lateral(); });
  Figure figure;
  figure.heading = "Error of the lateral offset";
  const double limit_m = error_axis_m(series, kLateral, series.lateral_limit_m);
  figure.caption = lateral_caption(series, limit_m);
  if (!series.has_route()) return figure;
  Json plot = route_plot(series, "Signed error of the lateral offset along the route", 220,
                         axis("lateral offset error (m)", -limit_m, limit_m, 3));
  add_errors(plot, series, kLateral);
  figure.plots.push_back(plot);
  return figure;
}

Figure matches_figure(const ReportSeries& series) {
  Figure figure = value_figure(matching_methods(series),
                               {"Matches per frame", "matches", "matches", 160, matches_of});
  const MethodSeries& reference = series.reference_method();
  std::vector<double> matches = values_of(reference, matches_of);
  std::sort(matches.begin(), matches.end());
  figure.caption =
      "The number of inlier tracklets or landmarks in the measurement of each frame; with few of "
      "them the error grows. " +
      reference.name + ": half of the frames have " + number(quantile(matches, 0.5), 0) +
      " or more, one in twenty " + number(quantile(matches, 0.05), 0) + " or fewer.";
  return figure;
}

Figure latency_figure(const ReportSeries& series) {
  Figure figure =
      value_figure(series, {"Latency per frame", "latency (ms)", "latency_ms", 120, latency_ms_of});
  const Summary& summary = series.reference_method().evaluation->summary;
  figure.caption = "From the decoded image to the fix. " + series.reference_method().name +
                   ": half of the frames take " + number(summary.latency_ms_p50, 0) +
                   " ms or less, 99\u00A0% at most " + number(summary.latency_ms_p99, 0) + " ms.";
  return figure;
}

}  // namespace milepost
