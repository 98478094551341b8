#include "client/evaluate/report/report_series.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <string_view>
#include <utility>

#include "client/evaluate/report/robust_reach.h"
#include "client/evaluate/statistics.h"
#include "schema/page/report_numbers.h"

namespace milepost {
namespace {

// The method of each colour of the style sheet, here and in the laboratory's report
// (tests/lab/laboratory/figures.py).
constexpr std::array<std::string_view, 9> kMethodOfColour = {kDefaultMethod,
                                                             "tracklet-regression-kalman",
                                                             "tracklet-regression",
                                                             "tracklet-regression-particle",
                                                             "tracklet-matching",
                                                             "scale-only",
                                                             "wisurf",
                                                             "tracklet-regression-unaveraged",
                                                             "inverse-scale"};
constexpr double kWidestToNarrowest = 8;  // largest ratio of the methods' error scales in one plot

double finite_or_nan(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? *value : kNaN;
}

bool on_one_segment(const std::vector<MethodEvaluation>& methods) {
  std::set<std::pair<std::string, std::string>> segments;  // map and segment
  for (const MethodEvaluation& method : methods) {
    for (const EvaluatedFix& fix : method.fixes) {
      const Fix& each = fix.frame.fix;
      if (!each.segment.empty()) segments.emplace(each.version.map, each.segment);
    }
  }
  return segments.size() <= 1;
}

// The distance driven since the first frame. An invalid position adds nothing.
std::vector<double> driven_m(const Drive& drive) {
  std::vector<double> driven;
  double sum_m = 0;
  const GeoPoint* last = nullptr;
  for (const Frame& frame : drive.frames) {
    if (is_valid(frame.position)) {
      if (last != nullptr) sum_m += geodesic_distance_m(*last, frame.position);
      last = &frame.position;
    }
    driven.push_back(sum_m);
  }
  return driven;
}

// The true arc length of each frame, from the first method that has it.
std::vector<double> truth_alongs(const std::vector<MethodEvaluation>& methods) {
  std::vector<double> alongs;
  for (const MethodEvaluation& evaluation : methods) {
    alongs.resize(std::max(alongs.size(), evaluation.fixes.size()), kNaN);
    for (std::size_t i = 0; i < evaluation.fixes.size(); ++i) {
      if (std::isnan(alongs[i])) alongs[i] = finite_or_nan(evaluation.fixes[i].truth_along_m);
    }
  }
  return alongs;
}

MethodSeries series_of(const MethodEvaluation& evaluation) {
  MethodSeries method;
  method.name = evaluation.summary.method;
  method.evaluation = &evaluation;
  for (const EvaluatedFix& fix : evaluation.fixes) {
    method.error_m.push_back(finite_or_nan(fix.error_m));
    method.lateral_error_m.push_back(finite_or_nan(fix.lateral_error_m));
    method.heading_error_deg.push_back(finite_or_nan(fix.heading_error_deg));
  }
  method.localized_errors_m = finite_only(method.error_m);
  std::sort(method.localized_errors_m.begin(), method.localized_errors_m.end());
  return method;
}

std::size_t reference_of(const std::vector<MethodEvaluation>& methods) {
  for (std::size_t i = 0; i < methods.size(); ++i) {
    if (methods[i].summary.method == kDefaultMethod) return i;
  }
  return 0;
}

// A known method always has its own colour; other methods take the unused ones.
void give_colours(ReportSeries& series) {
  std::vector<std::size_t> left_over;
  for (std::size_t colour = 0; colour < kMethodOfColour.size(); ++colour) {
    const bool taken = std::any_of(
        series.methods.begin(), series.methods.end(),
        [&](const MethodSeries& method) { return method.name == kMethodOfColour.at(colour); });
    if (!taken) left_over.push_back(colour);
  }
  std::size_t others = 0;
  for (MethodSeries& method : series.methods) {
    const auto* known = std::find(kMethodOfColour.begin(), kMethodOfColour.end(), method.name);
    const std::size_t colour = known != kMethodOfColour.end()
                                   ? static_cast<std::size_t>(known - kMethodOfColour.begin())
                               : left_over.empty() ? others++ % kMethodOfColour.size()
                                                   : left_over[others++ % left_over.size()];
    method.colour = "m" + std::to_string(colour);
  }
}

void place_on_route(ReportSeries& series, const ReportInput& input) {
  const bool by_along = input.drive == nullptr || on_one_segment(input.methods);
  series.route_label = by_along ? "true arc length" : "distance driven";
  series.route_m = by_along ? truth_alongs(input.methods) : driven_m(*input.drive);
  std::size_t frames = 0;
  for (const MethodSeries& method : series.methods) {
    frames = std::max(frames, method.error_m.size());
  }
  series.route_m.resize(frames, kNaN);
  series.route_from_m = series.route_to_m = kNaN;
  for (const double at_m : series.route_m) {  // fmin and fmax ignore NaN
    series.route_from_m = std::fmin(series.route_from_m, at_m);
    series.route_to_m = std::fmax(series.route_to_m, at_m);
  }
}

double error_limit_m(const std::vector<MethodSeries>& methods,
                     std::vector<double> MethodSeries::*errors_m) {
  double widest_m = 0;
  double narrowest_m = std::numeric_limits<double>::infinity();
  for (const MethodSeries& method : methods) {
    const double reach_m = robust_reach(method.*errors_m);
    widest_m = std::max(widest_m, reach_m);
    if (reach_m > 0) narrowest_m = std::min(narrowest_m, reach_m);
  }
  const double limit_m = std::min(widest_m, kWidestToNarrowest * narrowest_m);
  return limit_m > 0 ? limit_m : 0.1;
}

}  // namespace

bool ReportSeries::knows_lateral() const {
  return std::any_of(methods.begin(), methods.end(),
                     [](const MethodSeries& method) { return method.knows_lateral(); });
}

std::vector<const MethodSeries*> ReportSeries::back_to_front() const {
  std::vector<const MethodSeries*> order;
  for (const MethodSeries& method : methods) {
    if (&method != &methods[reference]) order.push_back(&method);
  }
  if (!methods.empty()) order.push_back(&methods[reference]);
  return order;
}

ReportSeries report_series(const ReportInput& input) {
  ReportSeries series;
  for (const MethodEvaluation& evaluation : input.methods) {
    series.methods.push_back(series_of(evaluation));
    series.methods.back().number = series.methods.size() - 1;
  }
  series.reference = reference_of(input.methods);
  give_colours(series);
  place_on_route(series, input);
  series.error_limit_m = error_limit_m(series.methods, &MethodSeries::error_m);
  series.lateral_limit_m = error_limit_m(series.methods, &MethodSeries::lateral_error_m);
  return series;
}

ReportSeries only(const ReportSeries& all, const std::function<bool(const MethodSeries&)>& shown) {
  ReportSeries chosen = all;
  chosen.methods.clear();
  chosen.reference = 0;
  for (const MethodSeries& method : all.methods) {
    if (!shown(method)) continue;
    if (&method == &all.reference_method()) chosen.reference = chosen.methods.size();
    chosen.methods.push_back(method);
  }
  return chosen;
}

}  // namespace milepost
