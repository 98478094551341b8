// The columns of the page: the result of each method for each frame.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "client/evaluate/report/report_figures.h"
#include "schema/page/report_numbers.h"

namespace milepost {
namespace {

constexpr std::array<FixStatus, 5> kStatuses = {FixStatus::initializing, FixStatus::tracking,
                                                FixStatus::predicted, FixStatus::lost,
                                                FixStatus::off_map};

struct Values {
  const char* name;
  const char* label;
  const char* unit;
  int decimals;
  bool is_signed;
  bool is_of_pose;  // known to methods that estimate the lateral offset
  double (*value)(const EvaluatedFix&);
};

constexpr std::array<Values, 7> kValues = {{
    {"error_m", "error", "m", 4, true, false,
     [](const EvaluatedFix& fix) { return fix.error_m.value_or(kNaN); }},
    {"sigma_m", "\u03C3", "m", 4, false, false,
     [](const EvaluatedFix& fix) { return fix.frame.fix.along_m ? fix.frame.fix.sigma_m : kNaN; }},
    {"lateral_error_m", "lateral", "m", 4, true, true,
     [](const EvaluatedFix& fix) { return fix.lateral_error_m.value_or(kNaN); }},
    {"lateral_sigma_m", "\u03C3", "m", 4, false, true,
     [](const EvaluatedFix& fix) { return fix.frame.fix.lateral_sigma_m.value_or(kNaN); }},
    {"heading_error_deg", "heading", "\u00B0", 2, true, true,
     [](const EvaluatedFix& fix) { return fix.heading_error_deg.value_or(kNaN); }},
    {"matches", "matches", "", 0, false, false,
     [](const EvaluatedFix& fix) { return static_cast<double>(fix.frame.fix.matches); }},
    {"latency_ms", "latency", "ms", 1, false, false,
     [](const EvaluatedFix& fix) { return fix.frame.latency_ms; }},
}};

Json column_of(const MethodEvaluation& evaluation, const Values& values, std::size_t frames) {
  std::vector<double> column;
  for (const EvaluatedFix& fix : evaluation.fixes) column.push_back(values.value(fix));
  column.resize(frames, kNaN);
  return rounded(column, values.decimals);
}

Json statuses_of(const MethodEvaluation& evaluation) {
  Json statuses = Json::array();
  for (const EvaluatedFix& fix : evaluation.fixes) {
    const auto* const at = std::find(kStatuses.begin(), kStatuses.end(), fix.frame.fix.status);
    statuses.push_back(at - kStatuses.begin());
  }
  return statuses;
}

Json status_words() {
  Json words = Json::array();
  for (const FixStatus status : kStatuses) words.push_back(name_of(status));
  return words;
}

// The names come from the method with the most frames.
Json names_of(const ReportSeries& series) {
  const MethodEvaluation* longest = series.methods.front().evaluation;
  for (const MethodSeries& method : series.methods) {
    if (method.evaluation->fixes.size() > longest->fixes.size()) longest = method.evaluation;
  }
  Json names = Json::array();
  for (const EvaluatedFix& fix : longest->fixes) names.push_back(fix.frame.filename);
  return names;
}

// The readout of a frame: the values of each method and its status.
Json rows_of(const ReportSeries& series) {
  Json rows = Json::array();
  for (const MethodSeries& method : series.methods) {
    Json readout = Json::array();
    for (const Values& values : kValues) {
      if (values.is_of_pose && !series.knows_lateral()) continue;
      readout.push_back({{"label", values.label},
                         {"column", method.column(values.name)},
                         {"unit", values.unit},
                         {"decimals", std::min(values.decimals, 3)},
                         {"signed", values.is_signed}});
    }
    readout.push_back(
        {{"label", "status"}, {"column", method.column("status")}, {"words", status_words()}});
    rows.push_back({{"name", method.name}, {"colour", method.colour}, {"values", readout}});
  }
  return rows;
}

}  // namespace

void add_frames(Json& page, const ReportSeries& series) {
  Json& columns = page["columns"];
  columns["route_m"] = rounded(series.route_m, 3);
  columns["frame"] = names_of(series);
  for (const MethodSeries& method : series.methods) {
    for (const Values& values : kValues) {
      if (values.is_of_pose && !series.knows_lateral()) continue;
      columns[method.column(values.name)] =
          column_of(*method.evaluation, values, series.route_m.size());
    }
    columns[method.column("status")] = statuses_of(*method.evaluation);
  }
  page["frames"] = {{"x", "route_m"}, {"names", "frame"}, {"label", series.route_label},
                    {"unit", "m"},    {"decimals", 2},    {"rows", rows_of(series)}};
}

}  // namespace milepost
