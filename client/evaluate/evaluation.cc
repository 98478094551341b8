#include "client/evaluate/evaluation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "client/evaluate/statistics.h"
#include "schema/geo/route_line.h"

namespace milepost {
namespace {

constexpr double kTruthRadiusM = 50;  // of a frame without a fix, to the nearest segment

struct SegmentName {
  MapVersion version;
  std::string id;

  friend bool operator<(const SegmentName& a, const SegmentName& b) {
    return std::tie(a.version.map, a.version.build, a.id) <
           std::tie(b.version.map, b.version.build, b.id);
  }
};

// The lines of the segments used, each read once.
class Lines {
 public:
  explicit Lines(MapSource& source) : source_(source) {}

  Result<const RouteLine*> of(const SegmentName& name) {
    const auto known = lines_.find(name);
    if (known != lines_.end()) return &known->second;
    const Result<SegmentDescription> segment = source_.segment(name.version, name.id);
    if (!segment) return segment.error();
    Result<RouteLine> line = RouteLine::from_vertices(segment->vertices);
    if (!line) return line.error();
    return &lines_.emplace(name, std::move(*line)).first->second;
  }

 private:
  MapSource& source_;
  std::map<SegmentName, RouteLine> lines_;
};

// The segment for a frame's ground truth: its fix's, or the nearest one.
Result<std::optional<SegmentName>> segment_for_truth(const Fix& fix, const GeoPoint& position,
                                                     MapSource& source) {
  if (fix.along_m) return std::optional(SegmentName{fix.version, fix.segment});
  const auto near = source.segments_near(position, kTruthRadiusM);
  if (!near) return near.error();
  if (near->empty()) return std::optional<SegmentName>();
  return std::optional(SegmentName{near->front().version, near->front().segment});
}

void summarize_errors(const std::vector<EvaluatedFix>& fixes, Summary& summary) {
  std::vector<double> errors_m;
  double within = 0;
  for (const EvaluatedFix& fix : fixes) {
    if (!fix.error_m) continue;
    errors_m.push_back(std::abs(*fix.error_m));
    if (errors_m.back() <= 2 * fix.frame.fix.sigma_m) ++within;
  }
  std::sort(errors_m.begin(), errors_m.end());
  summary.localized_frames = errors_m.size();
  summary.mean_error_m = mean_of(errors_m);
  summary.std_error_m = deviation_of(errors_m);
  summary.max_error_m = quantile(errors_m, 1);
  summary.p50_error_m = quantile(errors_m, 0.5);
  summary.p95_error_m = quantile(errors_m, 0.95);
  summary.within_2_sigma = within / static_cast<double>(errors_m.size());
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

Result<double> map_kb_per_m(const std::set<SegmentName>& driven, const std::string& layer,
                            Lines& lines, MapSource& source) {
  double bytes = 0;
  double length_m = 0;
  for (const SegmentName& name : driven) {
    const Result<std::uint64_t> of_segment = source.layer_bytes(name.version, name.id, layer);
    if (!of_segment) return of_segment.error();
    const Result<const RouteLine*> line = lines.of(name);
    if (!line) return line.error();
    bytes += static_cast<double>(*of_segment);
    length_m += (*line)->length_m();
  }
  return bytes / 1000 / length_m;
}

// Sets the ground truth relative to the line of the segment, and the errors of the fix.
void compare(const Frame& frame, const RouteLine& line, EvaluatedFix& evaluated) {
  const Fix& fix = evaluated.frame.fix;
  const LineProjection truth = line.project(frame.position);
  evaluated.truth_along_m = truth.along_m;
  evaluated.truth_lateral_m = truth.lateral_m;
  if (fix.along_m) evaluated.error_m = *fix.along_m - truth.along_m;
  if (fix.lateral_m) evaluated.lateral_error_m = *fix.lateral_m - truth.lateral_m;
  if (fix.heading_deg) evaluated.heading_error_deg = turn_deg(frame.heading_deg, *fix.heading_deg);
}

}  // namespace

Result<MethodEvaluation> evaluate_fixes(const std::string& method, const std::string& layer,
                                        const Drive& drive, const std::vector<FrameFix>& fixes,
                                        MapSource& source) {
  Lines lines(source);
  std::set<SegmentName> driven;
  MethodEvaluation evaluation;
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    EvaluatedFix evaluated{fixes[i], std::nullopt, std::nullopt};
    const auto name = segment_for_truth(fixes[i].fix, drive.frames[i].position, source);
    if (!name) return name.error();
    if (*name) {
      const Result<const RouteLine*> line = lines.of(**name);
      if (!line) return line.error();
      compare(drive.frames[i], **line, evaluated);
      if (fixes[i].fix.along_m) driven.insert(**name);
    }
    evaluation.fixes.push_back(std::move(evaluated));
  }
  Summary& summary = evaluation.summary;
  summary.method = method;
  summary.frames = fixes.size();
  summarize_errors(evaluation.fixes, summary);
  summarize_pose(evaluation.fixes, summary);
  summarize_latency(evaluation.fixes, summary);
  const Result<double> size = map_kb_per_m(driven, layer, lines, source);
  if (!size) return size.error();
  summary.map_kb_per_m = *size;
  return evaluation;
}

}  // namespace milepost
