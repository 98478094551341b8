#include "client/evaluate/output.h"

#include <cmath>
#include <cstdio>
#include <string_view>

#include <nlohmann/json.hpp>

#include "schema/base/csv_text.h"
#include "schema/base/digits.h"

namespace milepost {
namespace {

constexpr const char* kFixColumns =
    "timestamp_s,filename,status,segment,along_m,sigma_m,latitude_deg,longitude_deg,matches,"
    "latency_ms";
constexpr const char* kPoseColumns = "lateral_m,heading_deg,lateral_sigma_m";
constexpr const char* kMapColumn = "sigma_map_m";

bool has_sigma(const Fix& fix) { return fix.along_m || fix.position; }

void add_fix(CsvText& csv, const FrameFix& frame) {
  const Fix& fix = frame.fix;
  csv.rounded(fix.timestamp_s, 4).cell(frame.filename).cell(name_of(fix.status)).cell(fix.segment);
  csv.rounded(fix.along_m, 4);
  csv.rounded(has_sigma(fix) ? std::optional(fix.sigma_m) : std::nullopt, 4);
  csv.rounded(fix.position ? std::optional(fix.position->latitude_deg) : std::nullopt, 9);
  csv.rounded(fix.position ? std::optional(fix.position->longitude_deg) : std::nullopt, 9);
  csv.cell(static_cast<long long>(fix.matches)).rounded(frame.latency_ms, 2);
}

void add_pose(CsvText& csv, const Fix& fix) {
  csv.rounded(fix.lateral_m, 4).rounded(fix.heading_deg, 4).rounded(fix.lateral_sigma_m, 4);
}

void add_map_sigma(CsvText& csv, const Fix& fix) {
  csv.rounded(has_sigma(fix) ? std::optional(fix.sigma_map_m) : std::nullopt, 4);
}

nlohmann::ordered_json figure(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

// A cell of a human-readable table.
std::string cell(double value, int digits) {
  return std::isfinite(value) ? fixed(value, digits) : "-";
}

bool begins_fixes(std::string_view head) {
  return head.starts_with("timestamp_s,filename,status,");
}

bool begins_summary(std::string_view head) { return begins_without_space(head, R"([{"method":)"); }

}  // namespace

const OutputKind kFixesOutput = {"a table of fixes", begins_fixes, true};
const OutputKind kSummaryOutput = {"a summary of an evaluation", begins_summary, true};

std::string fixes_csv(const std::vector<FrameFix>& fixes) {
  CsvText csv(std::string(kFixColumns) + "," + kPoseColumns + "," + kMapColumn);
  for (const FrameFix& frame : fixes) {
    add_fix(csv, frame);
    add_pose(csv, frame.fix);
    add_map_sigma(csv, frame.fix);
    csv.end_row();
  }
  return csv.text();
}

std::string evaluated_fixes_csv(const std::vector<EvaluatedFix>& fixes) {
  CsvText csv(std::string(kFixColumns) + ",truth_along_m,error_m," + kPoseColumns +
              ",truth_lateral_m,lateral_error_m,heading_error_deg,truth_segment,distance_m," +
              kMapColumn);
  for (const EvaluatedFix& fix : fixes) {
    add_fix(csv, fix.frame);
    csv.rounded(fix.truth_along_m, 4).rounded(fix.error_m, 4);
    add_pose(csv, fix.frame.fix);
    csv.rounded(fix.truth_lateral_m, 4).rounded(fix.lateral_error_m, 4);
    csv.rounded(fix.heading_error_deg, 4);
    csv.cell(fix.truth_segment).rounded(fix.distance_m, 4);
    add_map_sigma(csv, fix.frame.fix);
    csv.end_row();
  }
  return csv.text();
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
                    {"max_heading_error_deg", figure(summary.heading_error_deg.max)},
                    {"mean_distance_m", figure(summary.distance_m.mean)},
                    {"p95_distance_m", figure(summary.distance_m.p95)},
                    {"max_distance_m", figure(summary.distance_m.max)},
                    {"wrong_segment_frames", summary.wrong_segment_frames},
                    {"within_2_sigma_map", figure(summary.within_2_sigma_map)}});
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
