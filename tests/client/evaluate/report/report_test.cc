// What the report says: rows, marks, captions, names that try to be markup.
#include "client/evaluate/report/report.h"

#include <gmock/gmock.h>

#include <cstdlib>
#include <limits>
#include <regex>

#include "schema/base/file.h"
#include "tests/client/evaluate/report/report_input.h"
#include "tests/support/temp_folder.h"

namespace milepost {
namespace {

using ::testing::ContainsRegex;
using testing::evaluation;
using ::testing::HasSubstr;
using testing::know_lateral;
using ::testing::Not;
using testing::report_input;
using testing::small_errors;
using testing::straight_drive;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Whether Python's XML parser reads the whole document.
bool is_well_formed(const std::string& html) {
  const testing::TempFolder folder;
  const std::string file = (folder / "report.html").string();
  EXPECT_TRUE(write_text_file(file, html).ok());
  const std::string script = "import sys, xml.etree.ElementTree as tree; tree.parse(sys.argv[1])";
  const std::string command =
      std::string(MILEPOST_PYTHON) + " -c '" + script + "' '" + file + "' 2>&1";
  return std::system(command.c_str()) == 0;
}

bool says_not_a_number(const std::string& html) {
  const std::string body = html.substr(html.find("<body>"));
  return std::regex_search(body, std::regex(R"(\b-?(nan|inf|infinity)\b)", std::regex::icase));
}

std::string row_of(const std::string& html, const std::string& method) {
  const std::size_t start = html.find("<tr><th scope=\"row\">" + method + "</th>");
  if (start == std::string::npos) return "";
  return html.substr(start, html.find("</tr>", start) - start);
}

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++count;
  }
  return count;
}

TEST(Report, HasARowForEachMethodWithAllItsNumbers) {
  const Drive drive = straight_drive(20);
  const std::string html = report_html(
      report_input(drive, {evaluation("tracklet-regression", drive, small_errors(20, 0.2)),
                           evaluation("milepost", drive, small_errors(20, 0.05))}));
  EXPECT_EQ(count_of(html, "<tr><th scope=\"row\">"), 2U);
  EXPECT_FALSE(row_of(html, "tracklet-regression").empty());
  const std::string row = row_of(html, "milepost");
  for (const char* number :
       {"0.070", "0.040", "0.310", "0.060", "0.210", "20/20", "94.0", "1.30", "73.0", "76.0"}) {
    EXPECT_THAT(row, HasSubstr(std::string(">") + number + "<")) << number;
  }
}

TEST(Report, MarksTheBestOfEachColumn) {
  const Drive drive = straight_drive(20);
  MethodEvaluation near = evaluation("near", drive, small_errors(20, 0.05));
  MethodEvaluation far = evaluation("far", drive, small_errors(20, 0.2));
  far.summary.mean_error_m = 0.4;
  far.summary.std_error_m = kNaN;
  near.summary.within_2_sigma = 1;  // 95 % is what two honest sigmas hold
  far.summary.latency_ms_p50 = 40;
  const std::string html = report_html(report_input(drive, {far, near}));
  EXPECT_THAT(row_of(html, "near"), HasSubstr("<strong>0.070</strong>"));
  EXPECT_THAT(row_of(html, "near"), HasSubstr("<strong>0.040</strong>"));
  EXPECT_THAT(row_of(html, "near"), HasSubstr(">100.0<"));
  EXPECT_THAT(row_of(html, "near"), Not(HasSubstr("<strong>100.0")));
  EXPECT_THAT(row_of(html, "near"), Not(HasSubstr("<strong>73.0")));
  EXPECT_THAT(row_of(html, "far"), Not(HasSubstr("<strong>0.400")));
  EXPECT_THAT(row_of(html, "far"), HasSubstr("<strong>94.0</strong>"));
  EXPECT_THAT(row_of(html, "far"), HasSubstr("<strong>40.0</strong>"));
  // Where both say the same, neither is better.
  EXPECT_THAT(html, Not(HasSubstr("<strong>1.30")));
}

TEST(Report, MethodsThatSayTheBestAlikeShareTheMark) {
  const Drive drive = straight_drive(20);
  std::vector<MethodEvaluation> methods;
  for (const char* name : {"light", "slim", "heavy"}) {
    methods.push_back(evaluation(name, drive, small_errors(20, 0.05)));
  }
  methods[2].summary.map_kb_per_m = 9;
  const std::string html = report_html(report_input(drive, methods));
  EXPECT_THAT(row_of(html, "light"), HasSubstr("<strong>1.30</strong>"));
  EXPECT_THAT(row_of(html, "slim"), HasSubstr("<strong>1.30</strong>"));
  EXPECT_THAT(row_of(html, "heavy"), Not(HasSubstr("<strong>")));
}

TEST(Report, MarksNothingWhereThereIsNothingToCompare) {
  const Drive drive = straight_drive(20);
  const std::string html =
      report_html(report_input(drive, {evaluation("milepost", drive, small_errors(20, 0.05))}));
  EXPECT_THAT(html, Not(HasSubstr("<strong>")));
  EXPECT_THAT(html, Not(HasSubstr("is underlined")));
}

// The element of a section or figure with that heading.
std::string part_of(const std::string& html, const std::string& heading, const std::string& end) {
  const std::size_t start = html.find("<h2>" + heading + "</h2>");
  return start == std::string::npos ? "" : html.substr(start, html.find(end, start) - start);
}

TEST(Report, LateralAndHeadingStandInATableOfTheMethodsThatKnowThem) {
  const Drive drive = straight_drive(20);
  MethodEvaluation ours = evaluation("milepost", drive, small_errors(20, 0.05));
  know_lateral(ours);
  const MethodEvaluation other = evaluation("inverse-scale", drive, small_errors(20, 0.2));
  const std::string html = report_html(report_input(drive, {other, ours}));
  EXPECT_TRUE(is_well_formed(html));
  EXPECT_FALSE(says_not_a_number(html));
  const std::string table = part_of(html, "Lateral position and heading", "</section>");
  EXPECT_EQ(count_of(table, "<tr><th scope=\"row\">"), 1U);
  for (const char* number : {"0.028", "0.084", "0.124", "67.0", "0.29", "0.85", "1.23"}) {
    EXPECT_THAT(row_of(table, "milepost"), HasSubstr(std::string(">") + number + "<")) << number;
  }
  EXPECT_THAT(html, HasSubstr("To the side it is off by 0.028\u00A0m in the mean"));
}

TEST(Report, LateralErrorsAreDrawnOfTheMethodsThatKnowThem) {
  const Drive drive = straight_drive(20);
  MethodEvaluation ours = evaluation("milepost", drive, small_errors(20, 0.05));
  know_lateral(ours);
  MethodEvaluation far = ours;
  far.summary.method = "far";
  far.fixes[3].lateral_error_m = 5;
  const MethodEvaluation other = evaluation("inverse-scale", drive, small_errors(20, 0.2));
  const std::string html = report_html(report_input(drive, {other, ours, far}));
  const std::string figure = part_of(html, "Error to the side", "</figure>");
  EXPECT_THAT(figure, HasSubstr("lateral error (m)"));
  EXPECT_THAT(figure, HasSubstr("m0 line chief"));
  EXPECT_THAT(figure, HasSubstr("class=\"band\""));
  EXPECT_THAT(figure, HasSubstr("67.0\u00A0% of its errors lie inside"));
  EXPECT_THAT(figure, ContainsRegex("errors beyond [0-9.]+\u00A0m: 1 of far\\."));
  EXPECT_THAT(figure, Not(HasSubstr("<i></i>inverse-scale</span>")));
  EXPECT_THAT(figure, ContainsRegex("milepost: [^,]*, lateral [^,]* m, heading [^,]*\u00B0, "
                                    "tracking"));
}

TEST(Report, WithoutLateralThereIsNeitherTableNorPanelOfIt) {
  const Drive drive = straight_drive(20);
  const std::string html =
      report_html(report_input(drive, {evaluation("milepost", drive, small_errors(20, 0.05))}));
  EXPECT_EQ(count_of(html, "<table>"), 1U);
  EXPECT_THAT(html, Not(HasSubstr("ateral")));
  EXPECT_THAT(html, Not(HasSubstr("To the side")));
}

TEST(Report, HeadingSaysWhatWasEvaluated) {
  const Drive drive = straight_drive(20);
  const std::string html =
      report_html(report_input(drive, {evaluation("milepost", drive, small_errors(20, 0.05))}));
  for (const char* fact : {"<h1>query</h1>", "<dd>town (build 4f1c9a2b)</dd>",
                           "<dd>http://127.0.0.1:8080</dd>", "<dd>2011-09-30</dd>",
                           "<dd>20 in 1.9 s, 600 \u00D7 500 pixels</dd>", "<dd>s1, 20.0 m</dd>"}) {
    EXPECT_THAT(html, HasSubstr(fact));
  }
  EXPECT_THAT(html, HasSubstr("Half of them are within 0.060\u00A0m"));
  EXPECT_THAT(html, HasSubstr("95\u00A0% within 0.21\u00A0m"));
}

TEST(Report, NamesCannotBecomeMarkup) {
  const std::string hostile = "\"'><script>alert(1)</script><img src=x onerror=y>&amp;\x01\xFF]]>";
  Drive drive = straight_drive(3);
  drive.name = drive.captured = drive.source = drive.licence = hostile;
  for (Frame& frame : drive.frames) frame.filename = hostile;
  ReportInput input = report_input(drive, {evaluation(hostile, drive, {0.01, kNaN, 0.03}),
                                           evaluation(hostile, drive, {0.01, 9, 0.03})});
  input.map_name = input.map_source = input.segment = hostile;
  const std::string html = report_html(input);
  EXPECT_TRUE(is_well_formed(html));
  EXPECT_THAT(html, Not(HasSubstr("<script")));
  EXPECT_THAT(html, Not(HasSubstr("<img")));
  EXPECT_THAT(html, Not(HasSubstr("\x01")));
  EXPECT_THAT(html, Not(HasSubstr("\xFF")));
  EXPECT_THAT(html, HasSubstr("&quot;&#39;&gt;&lt;script&gt;"));
  EXPECT_THAT(html, HasSubstr("&amp;amp;"));
}

TEST(Report, NeedsNothingElseAndRunsNothing) {
  const Drive drive = straight_drive(20);
  const std::string html =
      report_html(report_input(drive, {evaluation("milepost", drive, small_errors(20, 0.05))}));
  for (const char* loader :
       {"<script", "<link", "<img", "src=", "url(", "@import", "href=\"http"}) {
    EXPECT_THAT(html, Not(HasSubstr(loader)));
  }
  EXPECT_THAT(html, HasSubstr("default-src 'none'"));
}

TEST(Report, IsTheSameEachTime) {
  const Drive drive = straight_drive(50);
  const ReportInput input =
      report_input(drive, {evaluation("tracklet-regression", drive, small_errors(50, 0.3)),
                           evaluation("milepost", drive, small_errors(50, 0.05))});
  EXPECT_EQ(report_html(input), report_html(input));
}

TEST(Report, OutliersAreCountedInWordsAndDoNotStretchTheScale) {
  const Drive drive = straight_drive(100);
  std::vector<double> errors_m = small_errors(100, 0.1);
  errors_m[10] = 50;
  errors_m[20] = errors_m[30] = -50;
  const std::string html =
      report_html(report_input(drive, {evaluation("milepost", drive, errors_m)}));
  EXPECT_THAT(html, HasSubstr(">\u25C2 2 further<"));
  EXPECT_THAT(html, HasSubstr(">1 further \u25B8<"));
  EXPECT_THAT(html,
              ContainsRegex("Not drawn: below \u22120\\.[0-9]+\u00A0m lie 2 of milepost; above "
                            "0\\.[0-9]+\u00A0m lie 1 of milepost"));
  EXPECT_EQ(count_of(html, "<use href=\"#up\""), 1U);
  EXPECT_EQ(count_of(html, "<use href=\"#down\""), 2U);
}

TEST(Report, WithoutOutliersSaysThatNoneIsLeftOut) {
  const Drive drive = straight_drive(100);
  const std::string html =
      report_html(report_input(drive, {evaluation("milepost", drive, small_errors(100, 0.1))}));
  EXPECT_THAT(html, HasSubstr("No error is left out."));
  EXPECT_THAT(html, Not(HasSubstr("further")));
  EXPECT_THAT(html, Not(HasSubstr("<use ")));
}

TEST(Report, MarksFramesThatWereNotTracked) {
  const Drive drive = straight_drive(20);
  std::vector<double> errors_m = small_errors(20, 0.1);
  errors_m[7] = errors_m[8] = errors_m[9] = kNaN;
  MethodEvaluation method = evaluation("milepost", drive, errors_m);
  method.fixes[0].frame.fix.status = FixStatus::initializing;
  method.fixes[12].frame.fix.status = FixStatus::predicted;
  method.fixes[19].frame.fix.status = FixStatus::off_map;
  const std::string html = report_html(report_input(drive, {method}));
  for (const char* mark : {"milepost: initializing, 1 frame<", "milepost: lost, 3 frames<",
                           "milepost: predicted, 1 frame<", "milepost: off-map, 1 frame<",
                           "H4737\"><title>milepost: lost"}) {  // of 19 m the ninth
    EXPECT_THAT(html, HasSubstr(mark));
  }
  EXPECT_THAT(
      html, HasSubstr("milepost: 14 tracking, 1 predicted, 1 initializing, 3 lost and 1 off-map."));
}

TEST(Report, OverSeveralSegmentsTheRouteIsTheDistanceDriven) {
  const Drive drive = straight_drive(20);
  MethodEvaluation method = evaluation("milepost", drive, small_errors(20, 0.1));
  EXPECT_THAT(report_html(report_input(drive, {method})), HasSubstr("along the segment (m)"));
  for (std::size_t i = 10; i < 20; ++i) method.fixes[i].frame.fix.segment = "s2";
  const std::string html = report_html(report_input(drive, {method}));
  EXPECT_THAT(html, HasSubstr("distance driven (m)"));
  EXPECT_THAT(html, Not(HasSubstr("along the segment (m)")));
}

// Inputs at the edge of having something to draw: the report stays a document and says no NaN.
struct EdgeCase {
  const char* name;
  std::vector<double> errors_m;
};

class ReportOf : public ::testing::TestWithParam<EdgeCase> {};

TEST_P(ReportOf, IsADocumentWithoutNaN) {
  const Drive drive = straight_drive(GetParam().errors_m.size());
  MethodEvaluation method = evaluation("milepost", drive, GetParam().errors_m);
  if (method.summary.localized_frames == 0) {
    method.summary.mean_error_m = method.summary.p50_error_m = kNaN;
    method.summary.within_2_sigma = kNaN;
  }
  const std::string html = report_html(report_input(drive, {method}));
  EXPECT_TRUE(is_well_formed(html));
  EXPECT_FALSE(says_not_a_number(html));
  EXPECT_EQ(count_of(html, "<figure>"), 6U);
}

INSTANTIATE_TEST_SUITE_P(Edges, ReportOf,
                         ::testing::Values(EdgeCase{"NoFrame", {}}, EdgeCase{"OneFrame", {0.1}},
                                           EdgeCase{"OneLostFrame", {kNaN}},
                                           EdgeCase{"NothingLocalized", {kNaN, kNaN, kNaN}},
                                           EdgeCase{"NoError", {0, 0, 0, 0}},
                                           EdgeCase{"OneOfManyLocalized", {kNaN, kNaN, 0.2, kNaN}},
                                           EdgeCase{"OneSizeOfError", {0.1, 0.1, 0.1, 0.1}}),
                         [](const auto& tested) { return tested.param.name; });

TEST(Report, NumbersThatAreNoneAreLeftOut) {
  Drive drive = straight_drive(8);
  MethodEvaluation method = evaluation("milepost", drive, small_errors(8, 0.1));
  method.fixes[0].truth_along_m = kNaN;
  method.fixes[1].truth_along_m = std::nullopt;
  method.fixes[2].error_m = kInfinity;
  method.fixes[3].frame.fix.sigma_m = kNaN;
  method.fixes[4].frame.fix.sigma_m = kInfinity;
  method.fixes[5].frame.latency_ms = kNaN;
  method.fixes[6].frame.fix.position = GeoPoint{kNaN, kNaN, kNaN};
  method.summary.map_kb_per_m = kInfinity;
  drive.frames[7].position.latitude_deg = kNaN;
  drive.frames[7].timestamp_s = kNaN;
  ReportInput input = report_input(drive, {method});
  input.segment_length_m = kNaN;
  const std::string html = report_html(input);
  EXPECT_TRUE(is_well_formed(html));
  EXPECT_FALSE(says_not_a_number(html));
  EXPECT_THAT(html, HasSubstr("2 frames of milepost without a true position"));
  EXPECT_THAT(html, HasSubstr("frame2.jpg, 2.0 m\nmilepost: no fix"));
}

TEST(Report, WithoutDriveMethodsOrPositionsIsStillADocument) {
  const Drive drive = straight_drive(4);
  Drive nowhere = drive;
  for (Frame& frame : nowhere.frames) frame.position.longitude_deg = kNaN;
  const MethodEvaluation method = evaluation("milepost", drive, {0.1, 0.2, 0.3, 0.4});
  ReportInput no_drive = report_input(drive, {method});
  no_drive.drive = nullptr;
  ReportInput no_line = no_drive;
  no_line.segment_line.clear();
  ReportInput lost_positions = report_input(drive, {method});
  lost_positions.drive = &nowhere;
  for (const ReportInput& input :
       {ReportInput{}, report_input(drive, {}), no_drive, no_line, lost_positions}) {
    const std::string html = report_html(input);
    EXPECT_TRUE(is_well_formed(html));
    EXPECT_FALSE(says_not_a_number(html));
  }
}

TEST(Report, WithoutTruthOrPositionsSaysThatNothingCanBeDrawn) {
  const Drive drive = straight_drive(4);
  MethodEvaluation method = evaluation("milepost", drive, {kNaN, kNaN, kNaN, kNaN});
  for (EvaluatedFix& fix : method.fixes) fix.truth_along_m = std::nullopt;
  ReportInput input = report_input(drive, {method});
  input.drive = nullptr;
  input.segment_line.clear();
  EXPECT_EQ(count_of(report_html(input), "There is nothing to draw"), 6U);
}

TEST(Report, MoreFixesThanFramesHaveNoPlaceOnTheDistanceDriven) {
  const Drive drive = straight_drive(8);
  MethodEvaluation method = evaluation("milepost", drive, small_errors(8, 0.1));
  method.fixes[3].frame.fix.segment = "s2";
  const Drive shorter = straight_drive(5);
  EXPECT_THAT(report_html(report_input(shorter, {method})),
              HasSubstr("3 frames of milepost without a true position"));
}

TEST(Report, ErrorsOfOneSizeHaveNoNormalDistribution) {
  const Drive drive = straight_drive(4);
  const std::string html =
      report_html(report_input(drive, {evaluation("milepost", drive, {0.1, 0.1, 0.1, 0.1})}));
  EXPECT_THAT(html, Not(HasSubstr("class=\"density\"")));
  EXPECT_THAT(html, Not(HasSubstr("normal distribution")));
  const std::string other =
      report_html(report_input(drive, {evaluation("milepost", drive, {0.1, -0.1, 0.05, -0.05})}));
  EXPECT_THAT(other, HasSubstr("class=\"density\""));
}

TEST(Report, WhereNothingCanBeDrawnItSaysSo) {
  const Drive drive = straight_drive(3);
  const std::string html =
      report_html(report_input(drive, {evaluation("milepost", drive, {kNaN, kNaN, kNaN})}));
  EXPECT_THAT(html, HasSubstr("milepost placed none of 3 frames on the map."));
  EXPECT_THAT(html, Not(HasSubstr(">\u22120.4</text>")));     // no axis has negative matches
  EXPECT_EQ(count_of(html, "There is nothing to draw"), 2U);  // histogram and cumulative share
}

}  // namespace
}  // namespace milepost
