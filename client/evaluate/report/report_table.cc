#include "client/evaluate/report/report_table.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>

#include "client/evaluate/report/plot/text.h"

namespace milepost {
namespace {

using plot::escaped;
using plot::number;

constexpr double kWithin2SigmaOfNormal = 0.9545;

struct Column {
  const char* heading;
  const char* unit;
  std::string (*text)(const Summary&);
  // The smaller, the better; NaN takes no part.
  double (*badness)(const Summary&);
};

double localized_share(const Summary& summary) {
  return summary.frames > 0
             ? static_cast<double>(summary.localized_frames) / static_cast<double>(summary.frames)
             : std::numeric_limits<double>::quiet_NaN();
}

std::string localized_text(const Summary& summary) {
  return std::to_string(summary.localized_frames) + "/" + std::to_string(summary.frames);
}

double within_share(const Summary& summary) {
  return summary.localized_frames > 0 ? summary.within_2_sigma
                                      : std::numeric_limits<double>::quiet_NaN();
}

double off_normal(double share) { return std::abs(share - kWithin2SigmaOfNormal); }

using S = Summary;
using Columns = std::vector<Column>;

const Columns& along_columns() {
  static const Columns all = {
      {"mean", "m", [](const S& s) { return number(s.mean_error_m, 3); },
       [](const S& s) { return s.mean_error_m; }},
      {"std", "m", [](const S& s) { return number(s.std_error_m, 3); },
       [](const S& s) { return s.std_error_m; }},
      {"max", "m", [](const S& s) { return number(s.max_error_m, 3); },
       [](const S& s) { return s.max_error_m; }},
      {"p50", "m", [](const S& s) { return number(s.p50_error_m, 3); },
       [](const S& s) { return s.p50_error_m; }},
      {"p95", "m", [](const S& s) { return number(s.p95_error_m, 3); },
       [](const S& s) { return s.p95_error_m; }},
      {"localized", "", localized_text, [](const S& s) { return -localized_share(s); }},
      {"within 2\u03C3", "%", [](const S& s) { return number(100 * within_share(s), 1); },
       [](const S& s) { return off_normal(within_share(s)); }},
      {"map", "kB/m", [](const S& s) { return number(s.map_kb_per_m, 2); },
       [](const S& s) { return s.map_kb_per_m; }},
      {"latency p50", "ms", [](const S& s) { return number(s.latency_ms_p50, 1); },
       [](const S& s) { return s.latency_ms_p50; }},
      {"latency p99", "ms", [](const S& s) { return number(s.latency_ms_p99, 1); },
       [](const S& s) { return s.latency_ms_p99; }},
  };
  return all;
}

const Columns& pose_columns() {
  static const Columns all = {
      {"lateral mean", "m", [](const S& s) { return number(s.lateral_error_m.mean, 3); },
       [](const S& s) { return s.lateral_error_m.mean; }},
      {"lateral p95", "m", [](const S& s) { return number(s.lateral_error_m.p95, 3); },
       [](const S& s) { return s.lateral_error_m.p95; }},
      {"lateral max", "m", [](const S& s) { return number(s.lateral_error_m.max, 3); },
       [](const S& s) { return s.lateral_error_m.max; }},
      {"lateral within 2\u03C3", "%",
       [](const S& s) { return number(100 * s.lateral_within_2_sigma, 1); },
       [](const S& s) { return off_normal(s.lateral_within_2_sigma); }},
      {"heading mean", "\u00B0", [](const S& s) { return number(s.heading_error_deg.mean, 2); },
       [](const S& s) { return s.heading_error_deg.mean; }},
      {"heading p95", "\u00B0", [](const S& s) { return number(s.heading_error_deg.p95, 2); },
       [](const S& s) { return s.heading_error_deg.p95; }},
      {"heading max", "\u00B0", [](const S& s) { return number(s.heading_error_deg.max, 2); },
       [](const S& s) { return s.heading_error_deg.max; }},
  };
  return all;
}

// What the best cell of the column says. Methods that say the same share the mark, since a
// difference that is not printed is none; where all say the same there is none.
std::optional<std::string> best_text(const Column& column,
                                     const std::vector<MethodEvaluation>& methods) {
  const Summary* best = nullptr;
  for (const MethodEvaluation& method : methods) {
    const double badness = column.badness(method.summary);
    if (std::isfinite(badness) && (best == nullptr || badness < column.badness(*best))) {
      best = &method.summary;
    }
  }
  if (best == nullptr) return std::nullopt;
  const std::string text = column.text(*best);
  const bool all_the_same = std::all_of(
      methods.begin(), methods.end(),
      [&](const MethodEvaluation& method) { return column.text(method.summary) == text; });
  return all_the_same ? std::nullopt : std::optional(text);
}

std::string head(const Columns& columns) {
  std::string html = "<thead><tr><th scope=\"col\">method</th>";
  for (const Column& column : columns) {
    html += std::string("<th scope=\"col\">") + column.heading + " <small>" + column.unit +
            "</small></th>";
  }
  return html + "</tr></thead>\n";
}

std::string row(const Summary& summary, const Columns& columns,
                const std::vector<std::optional<std::string>>& best) {
  std::string html = "<tr><th scope=\"row\">" + escaped(summary.method) + "</th>";
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const Column& column = columns[i];
    const std::string text = column.text(summary);
    html += std::string("<td data-label=\"") + column.heading + "\" data-unit=\"" + column.unit +
            "\">" + (best[i] == text ? "<strong>" + text + "</strong>" : text) + "</td>";
  }
  return html + "</tr>\n";
}

std::string table(const Columns& columns, const std::vector<MethodEvaluation>& methods) {
  std::vector<std::optional<std::string>> best;
  for (const Column& column : columns) best.push_back(best_text(column, methods));
  std::string html = "<table>\n" + head(columns) + "<tbody>\n";
  for (const MethodEvaluation& method : methods) html += row(method.summary, columns, best);
  return html + "</tbody>\n</table>\n";
}

}  // namespace

std::string summary_table(const std::vector<MethodEvaluation>& methods) {
  return table(along_columns(), methods);
}

std::string pose_table(const std::vector<MethodEvaluation>& methods) {
  std::vector<MethodEvaluation> knowing;
  std::copy_if(methods.begin(), methods.end(), std::back_inserter(knowing),
               [](const MethodEvaluation& method) { return method.summary.knows_lateral(); });
  return knowing.empty() ? "" : table(pose_columns(), knowing);
}

}  // namespace milepost
