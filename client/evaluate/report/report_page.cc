#include "client/evaluate/report/report_page.h"

#include <string_view>

#include "client/evaluate/report/plot/chart.h"
#include "client/evaluate/report/plot/text.h"
#include "client/evaluate/report/report_style.h"

namespace milepost {
namespace {

using plot::escaped;

// In the title, between what the page is about and its kind.
constexpr const char* kMark = " \u2013 milepost ";

// The policy lets nothing run and nothing be loaded, whatever the names in the report say; pictures
// are part of the page.
std::string document_head(const PageHead& head) {
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
         "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src "
         "'unsafe-inline'; img-src data:\"/>\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n<title>" +
         escaped(head.title) + kMark + escaped(head.kind) + "</title>\n<style>" +
         std::string(report_style()) + "</style>\n</head>\n";
}

std::string heading(const PageHead& head) {
  std::string html = "<header>\n<p class=\"over\">milepost " + escaped(head.kind) + "</p>\n<h1>" +
                     escaped(head.title) + "</h1>\n<p class=\"lead\">" + escaped(head.lead) +
                     "</p>\n<dl>\n";
  for (const auto& [name, value] : head.facts) {
    html += "<div><dt>" + name + "</dt><dd>" + escaped(value.empty() ? "not stated" : value) +
            "</dd></div>\n";
  }
  return html + "</dl>\n</header>\n";
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

bool begins_report(std::string_view head) {
  return head.starts_with("<!DOCTYPE html>") && head.find(kMark) != std::string_view::npos;
}

}  // namespace

const OutputKind kReportOutput = {"a report of milepost", begins_report, true};

std::string html_of(const Figure& figure) {
  const std::string nothing =
      "<p class=\"empty\">There is nothing to draw: no frame has the numbers that this figure "
      "shows.</p>\n";
  return "<figure>\n<h2>" + escaped(figure.heading) + "</h2>\n" +
         (figure.drawing.empty() ? nothing : figure.legend + figure.drawing) + "<figcaption>" +
         escaped(figure.caption) + "</figcaption>\n</figure>\n";
}

Facts facts_of(const Drive& drive) {
  return {{"Captured", drive.captured},
          {"Frames", frames_fact(drive)},
          {"Recording", drive.source},
          {"Licence", drive.licence}};
}

std::string title_of(const Drive& drive) {
  return drive.name.empty() ? "unnamed drive" : drive.name;
}

std::string page(const PageHead& head, const std::string& content) {
  return document_head(head) + "<body>\n" + plot::Chart::definitions() + heading(head) + content +
         "</body>\n</html>\n";
}

}  // namespace milepost
