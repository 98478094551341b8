#include "client/evaluate/report/report_table.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <optional>
#include <string>

#include "schema/page/report_numbers.h"

namespace milepost {
namespace {

constexpr double kWithin2SigmaOfNormal = 0.9545;

struct Column {
  const char* heading;
  const char* unit;
  int decimals;
  std::function<double(const Summary&)> value;
  // Smaller is better; NaN is ignored. None: the value itself.
  std::function<double(const Summary&)> badness = nullptr;

  double badness_of(const Summary& summary) const {
    return badness ? badness(summary) : value(summary);
  }
};

using Columns = std::vector<Column>;
using S = Summary;

double localized_share(const Summary& summary) {
  return summary.frames > 0
             ? static_cast<double>(summary.localized_frames) / static_cast<double>(summary.frames)
             : kNaN;
}

double within_share(const Summary& summary) {
  return summary.localized_frames > 0 ? summary.within_2_sigma : kNaN;
}

double off_normal(double share) { return std::abs(share - kWithin2SigmaOfNormal); }

Columns along_columns() {
  return {{"mean", "m", 3, &S::mean_error_m},
          {"std", "m", 3, &S::std_error_m},
          {"max", "m", 3, &S::max_error_m},
          {"p50", "m", 3, &S::p50_error_m},
          {"p95", "m", 3, &S::p95_error_m},
          {"localized", "", 0, [](const S& s) { return s.localized_frames; },
           [](const S& s) { return -localized_share(s); }},
          {"frames", "", 0, [](const S& s) { return s.frames; }, [](const S&) { return kNaN; }},
          {"within 2\u03C3", "%", 1, [](const S& s) { return 100 * within_share(s); },
           [](const S& s) { return off_normal(within_share(s)); }},
          {"map", "kB/m", 2, &S::map_kb_per_m},
          {"latency p50", "ms", 1, &S::latency_ms_p50},
          {"latency p99", "ms", 1, &S::latency_ms_p99}};
}

Columns pose_columns() {
  return {
      {"lateral mean", "m", 3, [](const S& s) { return s.lateral_error_m.mean; }},
      {"lateral p95", "m", 3, [](const S& s) { return s.lateral_error_m.p95; }},
      {"lateral max", "m", 3, [](const S& s) { return s.lateral_error_m.max; }},
      {"lateral within 2\u03C3", "%", 1, [](const S& s) { return 100 * s.lateral_within_2_sigma; },
       [](const S& s) { return off_normal(s.lateral_within_2_sigma); }},
      {"heading mean", "\u00B0", 2, [](const S& s) { return s.heading_error_deg.mean; }},
      {"heading p95", "\u00B0", 2, [](const S& s) { return s.heading_error_deg.p95; }},
      {"heading max", "\u00B0", 2, [](const S& s) { return s.heading_error_deg.max; }}};
}

// The text of the best cell of the column. Methods with the same text share the mark, since a
// difference that is not printed is none; if all have the same there is none.
std::optional<std::string> best_text(const Column& column,
                                     const std::vector<MethodEvaluation>& methods) {
  const Summary* best = nullptr;
  for (const MethodEvaluation& method : methods) {
    const double badness = column.badness_of(method.summary);
    if (std::isfinite(badness) && (best == nullptr || badness < column.badness_of(*best))) {
      best = &method.summary;
    }
  }
  if (best == nullptr) return std::nullopt;
  const auto text_of = [&](const Summary& s) { return number(column.value(s), column.decimals); };
  const std::string text = text_of(*best);
  const bool all_the_same =
      std::all_of(methods.begin(), methods.end(),
                  [&](const MethodEvaluation& method) { return text_of(method.summary) == text; });
  return all_the_same ? std::nullopt : std::optional(text);
}

Json table(const Columns& columns, const std::vector<MethodEvaluation>& methods) {
  Json json = {{"columns", Json::array({words_column("method")})}, {"rows", Json::array()}};
  for (const MethodEvaluation& method : methods) {
    json["rows"].push_back(
        {{"cells", Json::array({method.summary.method})}, {"best", Json::array()}});
  }
  for (const Column& column : columns) {
    json["columns"].push_back(table_column(column.heading, column.unit, column.decimals));
    const std::optional<std::string> best = best_text(column, methods);
    for (std::size_t i = 0; i < methods.size(); ++i) {
      const double value = column.value(methods[i].summary);
      Json& row = json["rows"][i];
      if (best == number(value, column.decimals)) row["best"].push_back(row["cells"].size());
      row["cells"].push_back(rounded(value, column.decimals));
    }
  }
  return json;
}

}  // namespace

Json summary_table(const std::vector<MethodEvaluation>& methods) {
  return table(along_columns(), methods);
}

Json pose_table(const std::vector<MethodEvaluation>& methods) {
  std::vector<MethodEvaluation> knowing;
  std::copy_if(methods.begin(), methods.end(), std::back_inserter(knowing),
               [](const MethodEvaluation& method) { return method.summary.knows_lateral(); });
  return knowing.empty() ? Json() : table(pose_columns(), knowing);
}

}  // namespace milepost
