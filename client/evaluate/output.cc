#include "client/evaluate/output.h"

#include <cmath>
#include <cstdio>
#include <string_view>

#include <nlohmann/json.hpp>

#include "client/evaluate/cells.h"

namespace milepost {
namespace {

constexpr const char* kFixColumns =
    "timestamp_s,filename,status,segment,along_m,sigma_m,latitude_deg,longitude_deg,matches,"
    "latency_ms";
constexpr const char* kPoseColumns = "lateral_m,heading_deg,lateral_sigma_m";

std::string fix_cells(const FrameFix& frame) {
  const Fix& fix = frame.fix;
  const bool located = fix.along_m.has_value();
  std::string row =
      number(fix.timestamp_s, 4) + "," + frame.filename + "," + name_of(fix.status) + ",";
  row += fix.segment + "," + number(fix.along_m, 4) + ",";
  row += (located ? number(fix.sigma_m, 4) : "") + ",";
  row += (fix.position ? number(fix.position->latitude_deg, 9) : "") + ",";
  row += (fix.position ? number(fix.position->longitude_deg, 9) : "") + ",";
  return row + std::to_string(fix.matches) + "," + number(frame.latency_ms, 2);
}

std::string pose_cells(const Fix& fix) {
  return number(fix.lateral_m, 4) + "," + number(fix.heading_deg, 4) + "," +
         number(fix.lateral_sigma_m, 4);
}

nlohmann::ordered_json figure(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

// Of a table for a person.
std::string cell(double value, int digits) {
  return std::isfinite(value) ? number(value, digits) : "-";
}

bool begins_fixes(std::string_view head) {
  return head.starts_with("timestamp_s,filename,status,");
}

bool begins_summary(std::string_view head) { return begins_without_space(head, R"([{"method":)"); }

}  // namespace

const OutputKind kFixesOutput = {"a table of fixes", begins_fixes, true};
const OutputKind kSummaryOutput = {"a summary of an evaluation", begins_summary, true};

std::string fixes_csv(const std::vector<FrameFix>& fixes) {
  std::string text = std::string(kFixColumns) + "," + kPoseColumns + "\n";
  for (const FrameFix& frame : fixes) {
    text += fix_cells(frame) + "," + pose_cells(frame.fix) + "\n";
  }
  return text;
}

std::string evaluated_fixes_csv(const std::vector<EvaluatedFix>& fixes) {
  std::string text = std::string(kFixColumns) + ",truth_along_m,error_m," + kPoseColumns +
                     ",truth_lateral_m,lateral_error_m,heading_error_deg\n";
  for (const EvaluatedFix& fix : fixes) {
    text += fix_cells(fix.frame) + "," + number(fix.truth_along_m, 4) + "," +
            number(fix.error_m, 4) + "," + pose_cells(fix.frame.fix) + "," +
            number(fix.truth_lateral_m, 4) + "," + number(fix.lateral_error_m, 4) + "," +
            number(fix.heading_error_deg, 4) + "\n";
  }
  return text;
}

std::string summary_json(const std::vector<MethodEvaluation>& methods) {
  auto list = nlohmann::ordered_json::array();
  for (const MethodEvaluation& evaluation : methods) {
    const Summary& summary = evaluation.summary;
    list.push_back({{"method", summary.method},
                    {"mean_error_m", figure(summary.mean_error_m)},
                    {"std_error_m", figure(summary.std_error_m)},
                    {"max_error_m", figure(summary.max_error_m)},
                    {"p50_error_m", figure(summary.p50_error_m)},
                    {"p95_error_m", figure(summary.p95_error_m)},
                    {"frames", summary.frames},
                    {"localized_frames", summary.localized_frames},
                    {"within_2_sigma", figure(summary.within_2_sigma)},
                    {"map_kb_per_m", figure(summary.map_kb_per_m)},
                    {"latency_ms_p50", figure(summary.latency_ms_p50)},
                    {"latency_ms_p99", figure(summary.latency_ms_p99)},
                    {"mean_lateral_error_m", figure(summary.lateral_error_m.mean)},
                    {"p95_lateral_error_m", figure(summary.lateral_error_m.p95)},
                    {"max_lateral_error_m", figure(summary.lateral_error_m.max)},
                    {"lateral_within_2_sigma", figure(summary.lateral_within_2_sigma)},
                    {"mean_heading_error_deg", figure(summary.heading_error_deg.mean)},
                    {"p95_heading_error_deg", figure(summary.heading_error_deg.p95)},
                    {"max_heading_error_deg", figure(summary.heading_error_deg.max)}});
  }
  return list.dump(1) + "\n";
}

std::string summary_text(const std::vector<MethodEvaluation>& methods) {
  std::array<char, 256> line{};
  std::snprintf(line.data(), line.size(), "%-30s %7s %7s %7s %7s %11s %8s %7s %7s %9s %7s %11s\n",
                "method", "mean m", "std m", "p95 m", "max m", "localized", "in 2 sd", "kB/m",
                "ms p50", "lateral m", "p95 m", "heading deg");
  std::string text = line.data();
  for (const MethodEvaluation& evaluation : methods) {
    const Summary& s = evaluation.summary;
    const std::string localized =
        std::to_string(s.localized_frames) + "/" + std::to_string(s.frames);
    std::snprintf(line.data(), line.size(),
                  "%-30s %7.3f %7.3f %7.3f %7.3f %11s %7.0f%% %7.2f %7.1f %9s %7s %11s\n",
                  s.method.c_str(), s.mean_error_m, s.std_error_m, s.p95_error_m, s.max_error_m,
                  localized.c_str(), 100 * s.within_2_sigma, s.map_kb_per_m, s.latency_ms_p50,
                  cell(s.lateral_error_m.mean, 3).c_str(), cell(s.lateral_error_m.p95, 3).c_str(),
                  cell(s.heading_error_deg.mean, 2).c_str());
    text += line.data();
  }
  return text;
}

}  // namespace milepost
