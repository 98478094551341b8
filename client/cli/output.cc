#include "client/cli/output.h"

#include <cmath>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "client/cli/cells.h"

namespace milepost {
namespace {

constexpr const char* kFixColumns =
    "timestamp_s,filename,status,segment,along_m,sigma_m,latitude_deg,longitude_deg,matches,"
    "latency_ms";

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

nlohmann::ordered_json figure(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

}  // namespace

std::string fixes_csv(const std::vector<FrameFix>& fixes) {
  std::string text = std::string(kFixColumns) + "\n";
  for (const FrameFix& fix : fixes) text += fix_cells(fix) + "\n";
  return text;
}

std::string evaluated_fixes_csv(const std::vector<EvaluatedFix>& fixes) {
  std::string text = std::string(kFixColumns) + ",truth_along_m,error_m\n";
  for (const EvaluatedFix& fix : fixes) {
    text += fix_cells(fix.frame) + "," + number(fix.truth_along_m, 4) + "," +
            number(fix.error_m, 4) + "\n";
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
                    {"latency_ms_p99", figure(summary.latency_ms_p99)}});
  }
  return list.dump(1) + "\n";
}

std::string summary_text(const std::vector<MethodEvaluation>& methods) {
  std::array<char, 256> line{};
  std::snprintf(line.data(), line.size(), "%-30s %7s %7s %7s %7s %11s %8s %7s %7s\n", "method",
                "mean m", "std m", "p95 m", "max m", "localized", "in 2 sd", "kB/m", "ms p50");
  std::string text = line.data();
  for (const MethodEvaluation& evaluation : methods) {
    const Summary& s = evaluation.summary;
    const std::string localized =
        std::to_string(s.localized_frames) + "/" + std::to_string(s.frames);
    std::snprintf(line.data(), line.size(),
                  "%-30s %7.3f %7.3f %7.3f %7.3f %11s %7.0f%% %7.2f %7.1f\n", s.method.c_str(),
                  s.mean_error_m, s.std_error_m, s.p95_error_m, s.max_error_m, localized.c_str(),
                  100 * s.within_2_sigma, s.map_kb_per_m, s.latency_ms_p50);
    text += line.data();
  }
  return text;
}

}  // namespace milepost
