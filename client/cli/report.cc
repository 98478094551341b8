#include "client/cli/report.h"

#include <cmath>
#include <utility>

#include "client/cli/plot/chart.h"
#include "client/cli/plot/text.h"
#include "client/cli/report_figures.h"
#include "client/cli/report_style.h"
#include "client/cli/report_table.h"

namespace milepost {
namespace {

using plot::escaped;

std::string drive_name(const ReportInput& input) {
  return input.drive == nullptr || input.drive->name.empty() ? "unnamed drive" : input.drive->name;
}

// The policy lets nothing run and nothing be loaded, whatever the names in the report say.
std::string head(const ReportInput& input) {
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
         "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src "
         "'unsafe-inline'\"/>\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n<title>" +
         escaped(drive_name(input)) + " \u2013 milepost evaluation</title>\n<style>" +
         std::string(report_style()) + "</style>\n</head>\n";
}

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

std::string frames_fact(const Drive& drive) {
  std::string text = std::to_string(drive.frames.size());
  if (drive.frames.size() > 1) {
    const double duration_s = drive.frames.back().timestamp_s - drive.frames.front().timestamp_s;
    text += " in " + plot::number(duration_s, 1) + " s";
  }
  if (drive.camera.width_px > 0) {
    text += ", " + std::to_string(drive.camera.width_px) + " \u00D7 " +
            std::to_string(drive.camera.height_px) + " pixels";
  }
  return text;
}

using Facts = std::vector<std::pair<std::string, std::string>>;

Facts facts_of(const ReportInput& input) {
  Facts facts = {{"Map", input.map_name}, {"Tiles from", input.map_source}};
  if (!input.segment.empty()) {
    facts.emplace_back("Segment",
                       input.segment + ", " + plot::number(input.segment_length_m, 1) + " m");
  }
  if (input.drive != nullptr) {
    facts.emplace_back("Captured", input.drive->captured);
    facts.emplace_back("Frames", frames_fact(*input.drive));
    facts.emplace_back("Recording", input.drive->source);
    facts.emplace_back("Licence", input.drive->licence);
  }
  return facts;
}

std::string heading(const ReportInput& input, const ReportSeries& series) {
  std::string html = "<header>\n<p class=\"over\">milepost evaluation</p>\n<h1>" +
                     escaped(drive_name(input)) + "</h1>\n<p class=\"lead\">" +
                     escaped(lead(series)) + "</p>\n<dl>\n";
  for (const auto& [name, value] : facts_of(input)) {
    html += "<div><dt>" + name + "</dt><dd>" + escaped(value.empty() ? "not stated" : value) +
            "</dd></div>\n";
  }
  return html + "</dl>\n</header>\n";
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

std::string html_of(const Figure& figure) {
  const std::string nothing =
      "<p class=\"empty\">There is nothing to draw: no frame has the numbers that this figure "
      "shows.</p>\n";
  return "<figure>\n<h2>" + escaped(figure.heading) + "</h2>\n" +
         (figure.drawing.empty() ? nothing : figure.legend + figure.drawing) + "<figcaption>" +
         escaped(figure.caption) + "</figcaption>\n</figure>\n";
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
  std::string html = head(input) + "<body>\n" + plot::Chart::definitions() + heading(input, series);
  if (!input.methods.empty()) html += summary(input) + pose_summary(input) + figures(input, series);
  return html + "</body>\n</html>\n";
}

}  // namespace milepost
