#include "client/evaluate/report/report.h"

#include <cmath>
#include <utility>

#include "client/evaluate/report/plot/text.h"
#include "client/evaluate/report/report_figures.h"
#include "client/evaluate/report/report_numbers.h"
#include "client/evaluate/report/report_table.h"

namespace milepost {
namespace {

std::string lateral_lead(const Summary& summary) {
  if (!summary.knows_lateral()) return "";
  return " To the side it is off by " + metres(summary.lateral_error_m.mean) +
         " in the mean, 95\u00A0% by at most " + metres(summary.lateral_error_m.p95) + ".";
}

// What the best known method did, in a sentence or two.
std::string lead(const ReportSeries& series) {
  if (series.methods.empty()) return "No method was evaluated.";
  const Summary& summary = series.chief_method().evaluation->summary;
  if (summary.localized_frames == 0) {
    return summary.method + " placed none of " + counted(summary.frames, "frame") + " on the map.";
  }
  return summary.method + " placed " + std::to_string(summary.localized_frames) + " of " +
         counted(summary.frames, "frame") + " on the map. Half of them are within " +
         metres(summary.p50_error_m) + " of where the camera really was, 95\u00A0% within " +
         metres(summary.p95_error_m) + "; the worst is off by " + metres(summary.max_error_m) +
         "." + lateral_lead(summary);
}

Facts facts_of(const ReportInput& input) {
  Facts facts = {{"Map", input.map_name}, {"Tiles from", input.map_source}};
  if (!input.segment.empty()) {
    facts.emplace_back("Segment",
                       input.segment + ", " + plot::number(input.segment_length_m, 1) + " m");
  }
  if (input.drive != nullptr) {
    for (auto& fact : facts_of(*input.drive)) facts.push_back(std::move(fact));
  }
  return facts;
}

PageHead head(const ReportInput& input, const ReportSeries& series) {
  return {"evaluation", title_of(input.drive == nullptr ? Drive{} : *input.drive), lead(series),
          facts_of(input)};
}

std::string summary(const ReportInput& input) {
  std::string note =
      "Errors are absolute distances along the route between fix and truth, over the localized "
      "frames: those with a position on the map. Within 2\u03C3: the share of them that lies "
      "inside twice the reported standard deviation. Map: what the vehicle holds for the method on "
      "each metre of road. p50 and p95: half and 95\u00A0% are no larger.";
  if (input.methods.size() > 1) {
    note +=
        " The best of each column is underlined; within 2\u03C3 that is the nearest to "
        "95.4\u00A0%.";
  }
  return "<section>\n<h2>Summary</h2>\n" + summary_table(input.methods) + "<p class=\"note\">" +
         note + "</p>\n</section>\n";
}

std::string pose_summary(const ReportInput& input) {
  const std::string table = pose_table(input.methods);
  if (table.empty()) return "";
  return "<section>\n<h2>Lateral position and heading</h2>\n" + table +
         "<p class=\"note\">Of the methods that know where in the lane the camera is and where it "
         "looks. Lateral: absolute difference of the distances of fix and truth from the segment's "
         "line. Heading: absolute angle between the two. Within 2\u03C3: the share inside twice "
         "the "
         "reported lateral standard deviation.</p>\n</section>\n";
}

std::string figures(const ReportInput& input, const ReportSeries& series) {
  return html_of(error_figure(series)) +
         (series.knows_lateral() ? html_of(lateral_figure(series)) : "") +
         html_of(matches_figure(series)) + "<div class=\"pair\">\n" +
         html_of(histogram_figure(series)) + html_of(cumulative_figure(series)) + "</div>\n" +
         html_of(map_figure(input, series)) + html_of(latency_figure(series));
}

}  // namespace

std::string report_html(const ReportInput& input) {
  const ReportSeries series = report_series(input);
  std::string content;
  if (!input.methods.empty())
    content = summary(input) + pose_summary(input) + figures(input, series);
  return page(head(input, series), content);
}

}  // namespace milepost
