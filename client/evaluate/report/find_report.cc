#include "client/evaluate/report/find_report.h"

#include <cmath>

#include "client/evaluate/report/find_report_figures.h"
#include "client/evaluate/report/plot/text.h"
#include "client/evaluate/report/report_numbers.h"
#include "client/evaluate/report/report_plan.h"

namespace milepost {
namespace {

using plot::number;

constexpr std::size_t kMostSnapshots = 6;

std::string wrong_places(const FindSummary& summary) {
  if (summary.wrong_frames == 0) return "";
  return " In " + counted(summary.wrong_frames, "frame") +
         " it was taken to be in a wrong place, more than " + number(kWrongPlaceM, 0) + " m off.";
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
         " of where the camera really was, 95\u00A0% within " + metres(summary.position_m.p95) +
         "; the worst is off by " + metres(summary.position_m.max) + "." + wrong_places(summary);
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

std::string cell(const std::string& heading, const std::string& unit, const std::string& text) {
  return "<td data-label=\"" + heading + "\" data-unit=\"" + unit + "\">" + text + "</td>";
}

std::string row(const std::string& name, const std::string& unit, const FindErrorFigures& figures) {
  return "<tr><th scope=\"row\">" + name + " <small>" + unit + "</small></th>" +
         cell("mean", unit, number(figures.mean, 2)) + cell("p50", unit, number(figures.p50, 2)) +
         cell("p95", unit, number(figures.p95, 2)) + cell("max", unit, number(figures.max, 2)) +
         cell("within 2\u03C3", "%", number(100 * figures.within_2_sigma, 1)) + "</tr>\n";
}

std::string summary_section(const FindSummary& summary) {
  return "<section>\n<h2>Errors while tracked</h2>\n<table>\n<thead><tr><th "
         "scope=\"col\">error</th>"
         "<th scope=\"col\">mean</th><th scope=\"col\">p50</th><th scope=\"col\">p95</th>"
         "<th scope=\"col\">max</th><th scope=\"col\">within 2\u03C3 <small>%</small></th></tr>"
         "</thead>\n<tbody>\n" +
         row("position", "m", summary.position_m) + row("heading", "\u00B0", summary.heading_deg) +
         "</tbody>\n</table>\n<p class=\"note\">Of the frames that count as found: tracking, or "
         "carried on by the wheels. Position: distance along the ground from the recorded "
         "position. "
         "Heading: absolute angle to the recorded one. Within 2\u03C3: the share that lies inside "
         "twice the reported standard deviation; of honest ones 86.5\u00A0% of the positions, "
         "which "
         "have two directions to be off in, and 95.4\u00A0% of the headings. Only this report "
         "looks "
         "at recorded positions: the vehicle was found by frames and wheels "
         "alone.</p>\n</section>\n";
}

std::string snapshots_section(const FoundSeries& series) {
  const std::vector<Figure> figures = snapshot_figures(series);
  std::string html =
      "<section>\n<h2>The belief as it went</h2>\n" + plan_legend() + "<div class=\"pair\">\n";
  for (const Figure& figure : figures) html += html_of(figure);
  return html + "</div>\n</section>\n";
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
    const FindFix& fix = (*input.frames)[i].fix;
    series.time_s.push_back(fix.timestamp_s - start_s);
    series.recorded.push_back(on_plan(frame, input.drive->frames[i].position));
    series.found.push_back(on_plan(frame, fix.position));
  }
  return series;
}

std::string find_report_html(const FindReportInput& input) {
  const FoundSeries series = found_series(input);
  return page(
      {"find", title_of(*input.drive), lead(series.summary), facts_of(input, series.summary)},
      plan_ground(series) + summary_section(series.summary) + snapshots_section(series) +
          html_of(path_figure(series)) + html_of(position_error_figure(series)) +
          html_of(heading_error_figure(series)) + html_of(belief_figure(series)));
}

}  // namespace milepost
