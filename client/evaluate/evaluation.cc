#include "client/evaluate/evaluation.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "client/evaluate/road_truth.h"
#include "client/evaluate/statistics.h"
#include "schema/geo/route_line.h"

namespace milepost {
namespace {

void summarize_errors(const std::vector<EvaluatedFix>& fixes, Summary& summary) {
  std::vector<double> errors_m;
  double within = 0;
  double within_map = 0;
  for (const EvaluatedFix& fix : fixes) {
    if (!fix.error_m) continue;
    errors_m.push_back(std::abs(*fix.error_m));
    if (errors_m.back() <= 2 * fix.frame.fix.sigma_m) ++within;
    if (errors_m.back() <= 2 * fix.frame.fix.sigma_map_m) ++within_map;
  }
  std::sort(errors_m.begin(), errors_m.end());
  summary.localized_frames = errors_m.size();
  summary.mean_error_m = mean_of(errors_m);
  summary.std_error_m = deviation_of(errors_m);
  summary.max_error_m = quantile(errors_m, 1);
  summary.p50_error_m = quantile(errors_m, 0.5);
  summary.p95_error_m = quantile(errors_m, 0.95);
  summary.within_2_sigma = within / static_cast<double>(errors_m.size());
  summary.within_2_sigma_map = within_map / static_cast<double>(errors_m.size());
}

using ErrorOfFix = std::optional<double> EvaluatedFix::*;

ErrorFigures figures_of(const std::vector<EvaluatedFix>& fixes, ErrorOfFix error) {
  std::vector<double> errors;
  for (const EvaluatedFix& fix : fixes) {
    if (fix.*error) errors.push_back(std::abs(*(fix.*error)));
  }
  std::sort(errors.begin(), errors.end());
  return {mean_of(errors), quantile(errors, 0.95), quantile(errors, 1)};
}

double lateral_within_2_sigma(const std::vector<EvaluatedFix>& fixes) {
  double claimed = 0;
  double within = 0;
  for (const EvaluatedFix& fix : fixes) {
    const std::optional<double>& sigma_m = fix.frame.fix.lateral_sigma_m;
    if (!fix.lateral_error_m || !sigma_m) continue;
    ++claimed;
    if (std::abs(*fix.lateral_error_m) <= 2 * *sigma_m) ++within;
  }
  return within / claimed;
}

void summarize_pose(const std::vector<EvaluatedFix>& fixes, Summary& summary) {
  summary.lateral_error_m = figures_of(fixes, &EvaluatedFix::lateral_error_m);
  summary.lateral_within_2_sigma = lateral_within_2_sigma(fixes);
  summary.heading_error_deg = figures_of(fixes, &EvaluatedFix::heading_error_deg);
}

void summarize_latency(const std::vector<EvaluatedFix>& fixes, Summary& summary) {
  std::vector<double> latencies_ms;
  latencies_ms.reserve(fixes.size());
  for (const EvaluatedFix& fix : fixes) latencies_ms.push_back(fix.frame.latency_ms);
  std::sort(latencies_ms.begin(), latencies_ms.end());
  summary.latency_ms_p50 = quantile(latencies_ms, 0.5);
  summary.latency_ms_p99 = quantile(latencies_ms, 0.99);
}

Result<double> map_kb_per_m(const std::set<SegmentKey>& driven, const std::string& layer,
                            RoadTruth& truth, MapSource& source) {
  double bytes = 0;
  double length_m = 0;
  for (const SegmentKey& key : driven) {
    const Result<std::uint64_t> of_segment = source.layer_bytes(key.version, key.segment, layer);
    if (!of_segment) return of_segment.error();
    const Result<const RouteLine*> line = truth.line_of(key);
    if (!line) return line.error();
    bytes += static_cast<double>(*of_segment);
    length_m += (*line)->length_m();
  }
  return bytes / 1000 / length_m;
}

// How far a fix is ahead of the recorded position, in the recorded direction.
double ahead_m(const Frame& frame, const GeoPoint& fixed) {
  const EnuPoint off = LocalFrame(frame.position).enu_from_geo(fixed);
  const double heading_rad = frame.heading_deg * kRadPerDeg;
  return off.east_m * std::sin(heading_rad) + off.north_m * std::cos(heading_rad);
}

// Sets the ground truth, and the errors of the fix. A fix on a neighbouring segment is compared in
// plan, along the recorded direction; on a wrong road its error is the distance.
void compare(const Frame& frame, const std::optional<PlaceOnRoad>& truth, EvaluatedFix& evaluated) {
  const Fix& fix = evaluated.frame.fix;
  if (fix.position) evaluated.distance_m = geodesic_distance_m(frame.position, *fix.position);
  if (fix.heading_deg) evaluated.heading_error_deg = turn_deg(frame.heading_deg, *fix.heading_deg);
  if (truth) {
    evaluated.truth_segment = truth->segment.segment;
    evaluated.truth_along_m = truth->along_m;
    evaluated.truth_lateral_m = truth->lateral_m;
  }
  if (!fix.along_m) return;
  const bool is_there = truth && truth->segment == SegmentKey{fix.version, fix.segment};
  if (is_there) {
    evaluated.error_m = *fix.along_m - truth->along_m;
    if (fix.lateral_m) evaluated.lateral_error_m = *fix.lateral_m - truth->lateral_m;
    return;
  }
  evaluated.is_on_wrong_segment = true;
  if (!fix.position) return;
  constexpr double kSamePlaceM = 2;  // across a junction
  const bool is_near = truth && *evaluated.distance_m < kSamePlaceM + std::abs(truth->lateral_m);
  evaluated.error_m = is_near ? ahead_m(frame, *fix.position) : *evaluated.distance_m;
}

}  // namespace

Result<MethodEvaluation> evaluate_fixes(const std::string& method, const std::string& layer,
                                        const Drive& drive, const std::vector<FrameFix>& fixes,
                                        MapSource& source) {
  RoadTruth truth(source);
  std::set<SegmentKey> driven;
  MethodEvaluation evaluation;
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    EvaluatedFix evaluated{fixes[i]};
    const auto place = truth.place_of(drive.frames[i], fixes[i].fix);
    if (!place) return place.error();
    compare(drive.frames[i], *place, evaluated);
    if (fixes[i].fix.along_m) driven.insert({fixes[i].fix.version, fixes[i].fix.segment});
    evaluation.fixes.push_back(std::move(evaluated));
  }
  Summary& summary = evaluation.summary;
  summary.method = method;
  summary.frames = fixes.size();
  summarize_errors(evaluation.fixes, summary);
  summarize_pose(evaluation.fixes, summary);
  summarize_latency(evaluation.fixes, summary);
  summary.distance_m = figures_of(evaluation.fixes, &EvaluatedFix::distance_m);
  summary.wrong_segment_frames = static_cast<std::size_t>(
      std::ranges::count(evaluation.fixes, true, &EvaluatedFix::is_on_wrong_segment));
  const Result<double> size = map_kb_per_m(driven, layer, truth, source);
  if (!size) return size.error();
  summary.map_kb_per_m = *size;
  return evaluation;
}

}  // namespace milepost
