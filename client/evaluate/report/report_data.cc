#include "client/evaluate/report/report_data.h"

#include <cmath>
#include <utility>

#include "client/evaluate/report/drive_facts.h"
#include "client/evaluate/report/report_figures.h"
#include "client/evaluate/report/report_table.h"
#include "schema/page/report_numbers.h"

namespace milepost {
namespace {

std::string lateral_lead(const Summary& summary) {
  if (!summary.knows_lateral()) return "";
  return " The mean error of its lateral offset is " + metres(summary.lateral_error_m.mean) +
         ", 95\u00A0% are within " + metres(summary.lateral_error_m.p95) + ".";
}

std::string wrong_segment_clause(const Summary& summary) {
  if (summary.wrong_segment_frames == 0) return "";
  return ", " + std::to_string(summary.wrong_segment_frames) + " on a wrong segment";
}

// The result of the reference method in one or two sentences.
std::string lead(const ReportSeries& series) {
  if (series.methods.empty()) return "No method was evaluated.";
  const Summary& summary = series.reference_method().evaluation->summary;
  if (summary.localized_frames == 0) {
    return summary.method + " placed none of " + counted(summary.frames, "frame") + " on the map.";
  }
  return summary.method + " placed " + std::to_string(summary.localized_frames) + " of " +
         counted(summary.frames, "frame") + " on the map" + wrong_segment_clause(summary) +
         ". Half of them are within " + metres(summary.p50_error_m) +
         " of the recorded position, 95\u00A0% within " + metres(summary.p95_error_m) +
         "; the largest error is " + metres(summary.max_error_m) + "." + lateral_lead(summary);
}

// The segments with a fix: one by its name, several by their number.
std::string driven_text(const std::vector<RoadAround>& roads) {
  std::size_t driven = 0;
  double length_m = 0;
  std::string name;
  for (const RoadAround& road : roads) {
    if (!road.is_driven) continue;
    ++driven;
    length_m += road.length_m;
    name = road.segment.segment;
  }
  if (driven == 0) return "";
  return (driven == 1 ? name : counted(driven, "segment")) + ", " + number(length_m, 1) + " m";
}

Facts facts_of(const ReportInput& input) {
  Facts facts = {{"Map", input.map_name}, {"Tiles from", input.map_source}};
  if (const std::string driven = driven_text(input.roads); !driven.empty()) {
    facts.emplace_back("Driven", driven);
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

constexpr const char* kSummaryNote =
    "Errors are absolute differences of the arc lengths of fix and truth, over the localized "
    "frames: those with a position on the map. Within 2\u03C3: the share of them within twice the "
    "reported standard deviation. Map: the data that the vehicle holds for the method per metre of "
    "road. p50 and p95: the median and the 95th percentile.";
constexpr const char* kBestNote =
    " The best of each column is underlined; within 2\u03C3 that is the nearest to 95.4\u00A0%.";
constexpr const char* kPoseNote =
    "Of the methods that estimate lateral offset and heading. Lateral: absolute difference of the "
    "lateral offsets of fix and truth from the segment's line. Heading: absolute angle between the "
    "two. Within 2\u03C3: the share within twice the reported standard deviation of the lateral "
    "offset.";

Json table_part(const std::string& heading, const std::string& note, const Json& table) {
  Json part = {{"part", "table"}, {"heading", heading}, {"note", note}};
  part.update(table);
  return part;
}

Json parts_of(const ReportInput& input, const ReportSeries& series) {
  Json parts = Json::array();
  parts.push_back(
      table_part("Summary", std::string(kSummaryNote) + (input.methods.size() > 1 ? kBestNote : ""),
                 summary_table(input.methods)));
  const Json pose = pose_table(input.methods);
  if (!pose.is_null()) {
    parts.push_back(table_part("Lateral offset and heading", kPoseNote, pose));
  }
  parts.push_back(json_of(error_figure(series)));
  if (series.knows_lateral()) parts.push_back(json_of(lateral_figure(series)));
  parts.push_back(json_of(matches_figure(series)));
  parts.push_back(
      {{"part", "group"},
       {"parts", {json_of(histogram_figure(series)), json_of(cumulative_figure(series))}}});
  parts.push_back(json_of(map_figure(input, series)));
  parts.push_back(json_of(latency_figure(series)));
  return parts;
}

}  // namespace

Json report_data(const ReportInput& input) {
  const ReportSeries series = report_series(input);
  Json page = json_of(head(input, series));
  page["columns"] = Json::object();
  page["parts"] = Json::array();
  if (input.methods.empty()) return page;
  add_frames(page, series);
  add_places(page, input);
  page["parts"] = parts_of(input, series);
  return page;
}

}  // namespace milepost
