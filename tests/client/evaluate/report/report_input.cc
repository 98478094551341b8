#include "tests/client/evaluate/report/report_input.h"

#include <cmath>
#include <utility>

namespace milepost::testing {
namespace {

GeoPoint place(double along_m) {
  static const LocalFrame frame({49.0, 8.4, 110});
  return frame.geo_from_enu({0.8 * along_m, 0.6 * along_m, 0});
}

}  // namespace

Drive straight_drive(std::size_t frames) {
  Drive drive;
  drive.name = "query";
  drive.captured = "2011-09-30";
  drive.camera = {600, 500, 357.5, 400.1, 300, 250};
  for (std::size_t i = 0; i < frames; ++i) {
    Frame frame;
    frame.filename = "frame" + std::to_string(i) + ".jpg";
    frame.timestamp_s = 0.1 * static_cast<double>(i);
    frame.position = place(static_cast<double>(i));
    drive.frames.push_back(frame);
  }
  return drive;
}

MethodEvaluation evaluation(const std::string& method, const Drive& drive,
                            const std::vector<double>& errors_m) {
  MethodEvaluation result;
  for (std::size_t i = 0; i < errors_m.size(); ++i) {
    EvaluatedFix fix;
    fix.frame.filename = drive.frames[i].filename;
    fix.frame.latency_ms = 70 + static_cast<double>(i % 7);
    fix.frame.fix.status = FixStatus::lost;
    fix.truth_along_m = static_cast<double>(i);
    if (!std::isnan(errors_m[i])) {
      fix.frame.fix.status = FixStatus::tracking;
      fix.frame.fix.segment = "s1";
      fix.frame.fix.along_m = static_cast<double>(i) + errors_m[i];
      fix.frame.fix.sigma_m = 0.05;
      fix.frame.fix.sigma_map_m = 0.048;
      fix.frame.fix.position = place(*fix.frame.fix.along_m);
      fix.frame.fix.matches = 30;
      fix.error_m = errors_m[i];
      ++result.summary.localized_frames;
    }
    result.fixes.push_back(fix);
  }
  result.summary.method = method;
  result.summary.frames = errors_m.size();
  result.summary.mean_error_m = 0.07;
  result.summary.std_error_m = 0.04;
  result.summary.max_error_m = 0.31;
  result.summary.p50_error_m = 0.06;
  result.summary.p95_error_m = 0.21;
  result.summary.within_2_sigma = 0.94;
  result.summary.map_kb_per_m = 1.3;
  result.summary.latency_ms_p50 = 73;
  result.summary.latency_ms_p99 = 76;
  return result;
}

void know_lateral(MethodEvaluation& method) {
  for (EvaluatedFix& fix : method.fixes) {
    if (!fix.error_m) continue;
    fix.truth_lateral_m = 1;
    fix.lateral_error_m = 0.4 * *fix.error_m;
    fix.heading_error_deg = 0.4 * *fix.error_m;
    fix.frame.fix.lateral_m = 1 + *fix.lateral_error_m;
    fix.frame.fix.lateral_sigma_m = 0.02;
    fix.frame.fix.heading_deg = 53;
  }
  method.summary.lateral_error_m = {0.028, 0.084, 0.124};
  method.summary.lateral_within_2_sigma = 0.67;
  method.summary.heading_error_deg = {0.29, 0.85, 1.23};
}

std::vector<double> small_errors(std::size_t frames, double scale_m) {
  std::vector<double> errors_m;
  for (std::size_t i = 0; i < frames; ++i) {
    errors_m.push_back(scale_m * std::sin(static_cast<double>(i) * 12.9898));
  }
  return errors_m;
}

ReportInput report_input(const Drive& drive, std::vector<MethodEvaluation> methods) {
  ReportInput input;
  input.map_name = "town (build 4f1c9a2b)";
  input.map_source = "http://127.0.0.1:8080";
  input.drive = &drive;
  RoadAround road;
  road.segment = {{"town", "4f1c9a2b"}, "s1"};
  road.length_m = static_cast<double>(drive.frames.size());
  for (const Frame& frame : drive.frames) road.line.push_back(frame.position);
  road.is_driven = true;
  input.roads.push_back(std::move(road));
  input.methods = std::move(methods);
  return input;
}

}  // namespace milepost::testing
