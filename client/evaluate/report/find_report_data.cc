#include "client/evaluate/report/find_report_data.h"

#include <cmath>

#include "client/evaluate/report/drive_facts.h"
#include "client/evaluate/report/find_report_figures.h"
#include "schema/page/report_numbers.h"
#include "schema/page/report_plan.h"

namespace milepost {
namespace {

constexpr std::size_t kMostSnapshots = 6;

std::string wrong_places(const FindSummary& summary) {
  if (summary.wrong_frames == 0) return "";
  return " In " + counted(summary.wrong_frames, "frame") + " the position was wrong by more than " +
         number(kWrongPlaceM, 0) + " m.";
}

std::string lead(const FindSummary& summary) {
  if (!summary.found_frame) {
    return "The vehicle was not found in " + counted(summary.frames, "frame") + ".";
  }
  std::string text = "Found after " + number(summary.found_after_s, 1) + " s, and tracked in " +
                     std::to_string(summary.tracked_frames) + " of " +
                     counted(summary.frames, "frame") + ".";
  if (std::isnan(summary.position_m.p50)) return text;
  return text + " Half of these are within " + metres(summary.position_m.p50) +
         " of the recorded position, 95\u00A0% within " + metres(summary.position_m.p95) +
         "; the largest error is " + metres(summary.position_m.max) + "." + wrong_places(summary);
}

Facts facts_of(const FindReportInput& input, const FindSummary& summary) {
  const double tracked_percent =
      100 * static_cast<double>(summary.tracked_frames) / static_cast<double>(summary.frames);
  Facts facts = {
      {"Found after", summary.found_frame ? number(summary.found_after_s, 1) + " s" : "never"},
      {"Tracked", number(tracked_percent, 1) + "\u00A0% of the frames"},
      {"Latency", "p50 " + number(summary.latency_ms_p50, 1) + " ms, p99 " +
                      number(summary.latency_ms_p99, 1) + " ms"},
      {"Filter", input.settings},
      {"Map", input.map_name},
      {"Walls", std::to_string(input.recorder->walls().size()) + " from " + input.map_source}};
  for (auto& fact : facts_of(*input.drive)) facts.push_back(std::move(fact));
  return facts;
}

constexpr const char* kSummaryNote =
    "Over the frames with the status tracking or predicted. Position: horizontal distance from the "
    "recorded position. Heading: absolute angle to the recorded one. Within 2\u03C3: the share of "
    "errors within twice the reported standard deviation; for a consistent estimate 86.5\u00A0% of "
    "the positions (in two dimensions) and 95.4\u00A0% of the headings. Only this report uses "
    "recorded positions: the vehicle was localized by frames and odometry alone.";

Json row(const std::string& name, const FindErrorFigures& figures) {
  return {{"cells",
           {name, rounded(figures.mean, 2), rounded(figures.p50, 2), rounded(figures.p95, 2),
            rounded(figures.max, 2), rounded(100 * figures.within_2_sigma, 1)}}};
}

Json summary_part(const FindSummary& summary) {
  return {
      {"part", "table"},
      {"heading", "Errors while tracked"},
      {"note", kSummaryNote},
      {"columns",
       {words_column("error"), table_column("mean", "", 2), table_column("p50", "", 2),
        table_column("p95", "", 2), table_column("max", "", 2),
        table_column("within 2\u03C3", "%", 1)}},
      {"rows",
       {row("position (m)", summary.position_m), row("heading (\u00B0)", summary.heading_deg)}}};
}

Json snapshots_part(const FoundSeries& series) {
  Json parts = Json::array();
  for (const Figure& figure : snapshot_figures(series)) parts.push_back(json_of(figure));
  return {{"part", "group"},
          {"heading", "The belief over time"},
          {"keys", plan_keys()},
          {"parts", parts}};
}

}  // namespace

FoundSeries found_series(const FindReportInput& input) {
  FoundSeries series;
  series.input = &input;
  series.snapshots = input.recorder->chosen(kMostSnapshots);
  series.errors = find_errors(*input.drive, *input.frames);
  series.summary = find_summary(*input.frames, series.errors);
  const LocalFrame frame(input.recorder->origin());
  const double start_s = input.frames->front().fix.timestamp_s;
  for (std::size_t i = 0; i < input.frames->size(); ++i) {
    const GlobalPoseEstimate& fix = (*input.frames)[i].fix;
    series.time_s.push_back(fix.timestamp_s - start_s);
    series.recorded.push_back(on_plan(frame, input.drive->frames[i].position));
    series.found.push_back(on_plan(frame, fix.position));
  }
  return series;
}

Json find_report_data(const FindReportInput& input) {
  const FoundSeries series = found_series(input);
  Json page = json_of(PageHead{"find", title_of(*input.drive), lead(series.summary),
                               facts_of(input, series.summary)});
  add_frames(page, series);
  add_ground(page, series);
  page["parts"] = {summary_part(series.summary),          snapshots_part(series),
                   json_of(path_figure(series)),          json_of(position_error_figure(series)),
                   json_of(heading_error_figure(series)), json_of(belief_figure(series))};
  return page;
}

}  // namespace milepost
