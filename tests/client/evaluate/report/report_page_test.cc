// The page of a report: it is self-contained, and strings stay strings.
#include "schema/page/report_page.h"

#include <gmock/gmock.h>

#include <limits>
#include <regex>

#include "client/evaluate/report/report_data.h"
#include "schema/page/report_numbers.h"
#include "tests/client/evaluate/report/report_input.h"

namespace milepost {
namespace {

using testing::evaluation;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::report_input;
using testing::small_errors;
using testing::straight_drive;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::string embedded(const std::string& page) {
  const std::string opening = R"(<script type="application/json" id="data">)";
  const std::size_t start = page.find(opening) + opening.size();
  return page.substr(start, page.find("</script>", start) - start);
}

TEST(ReportPage, HoldsTheDataTheLibraryAndItsLicence) {
  const Json data = {{"kind", "test"}, {"title", "a <b> & \u2028 c"}};
  const std::string page = report_page(data);
  EXPECT_EQ(Json::parse(embedded(page)), data);
  EXPECT_THAT(page, HasSubstr("Chart.js v3."));
  EXPECT_THAT(page, HasSubstr("The above copyright notice and this permission notice shall be"));
  EXPECT_THAT(page, HasSubstr("<noscript>"));
  EXPECT_THAT(page.substr(page.size() - 100), Not(HasSubstr("@")));
  EXPECT_TRUE(kReportOutput.begins_with(std::string_view(page).substr(0, kOutputHeadBytes)));
}

TEST(ReportPage, LoadsNothingAndRunsItsOwnScriptsOnly) {
  const std::string page = report_page(Json::object());
  for (const char* loader : {"<link", "<img", " src=", "url(", "@import", "href=\"http"}) {
    EXPECT_THAT(page, Not(HasSubstr(loader)));
  }
  EXPECT_TRUE(std::regex_search(
      page, std::regex("default-src 'none'; style-src 'unsafe-inline'; img-src data:; "
                       "script-src 'sha256-[A-Za-z0-9+/]{43}=' 'sha256-[A-Za-z0-9+/]{43}='\"")));
}

TEST(ReportPage, NamesCannotBecomeMarkup) {
  const std::string hostile =
      "\"'></script><script>alert(1)</script><!--<img src=x onerror=y>&amp;\x01\xFF]]>@DATA@";
  Drive drive = straight_drive(3);
  drive.name = drive.captured = drive.source = drive.licence = hostile;
  for (Frame& frame : drive.frames) frame.filename = hostile;
  ReportInput input = report_input(drive, {evaluation(hostile, drive, {0.01, kNaN, 0.03}),
                                           evaluation(hostile, drive, {0.01, 9, 0.03})});
  input.map_name = input.map_source = input.roads.front().segment.segment = hostile;
  const std::string page = report_page(report_data(input));
  const std::string data = embedded(page);
  EXPECT_EQ(data.find('<'), std::string::npos);
  EXPECT_THAT(page, Not(HasSubstr("<script>alert")));
  EXPECT_THAT(page, Not(HasSubstr("<img")));
  EXPECT_THAT(page, Not(HasSubstr("\x01")));
  EXPECT_THAT(page, Not(HasSubstr("\xFF")));
  const std::string read = Json::parse(data)["title"];
  EXPECT_THAT(read, HasSubstr("\"'></script><script>alert(1)"));
  EXPECT_THAT(read, HasSubstr("&amp;\x01\uFFFD]]>@DATA@"));
}

TEST(ReportPage, IsTheSameEachTime) {
  const Drive drive = straight_drive(50);
  const ReportInput input =
      report_input(drive, {evaluation("tracklet-regression", drive, small_errors(50, 0.3)),
                           evaluation("milepost", drive, small_errors(50, 0.05))});
  EXPECT_EQ(report_page(report_data(input)), report_page(report_data(input)));
}

TEST(ReportPage, OfALongDriveByAllMethodsStaysSmall) {
  const Drive drive = straight_drive(2000);
  std::vector<MethodEvaluation> methods;
  for (const char* name :
       {"wisurf", "scale-only", "tracklet-matching", "tracklet-regression",
        "tracklet-regression-kalman", "tracklet-regression-particle", "milepost"}) {
    methods.push_back(evaluation(name, drive, small_errors(2000, 0.3)));
  }
  EXPECT_LT(report_page(report_data(report_input(drive, methods))).size(), 1'500'000U);
}

TEST(ReportJson, NumbersAreRoundedAndUnknownOnesNull) {
  EXPECT_EQ(rounded({0.12345, -2.0, kNaN, kInfinity, -0.0001, 1e300}, 3).dump(),
            "[0.123,-2,null,null,0,1e+300]");
}

TEST(ReportNumbers, AreForReaders) {
  EXPECT_EQ(number(0.256, 2), "0.26");
  EXPECT_EQ(number(-0.256, 2), "\u22120.26");
  EXPECT_EQ(number(-0.001, 2), "0.00");
  EXPECT_EQ(number(kNaN, 2), "\u2013");
  EXPECT_EQ(number(-kInfinity, 2), "\u2013");
  EXPECT_EQ(number(1e300, 2).size(), 304U);
  EXPECT_EQ(signed_number(0.256, 2), "+0.26");
  EXPECT_EQ(signed_number(0.001, 2), "0.00");
  EXPECT_EQ(signed_number(-1, 0), "\u22121");
  EXPECT_EQ(metres(0.0996), "0.10\u00A0m");
  EXPECT_EQ(listed({"a", "b", "c"}), "a, b and c");
}

TEST(ReportNumbers, StepsAreRound) {
  EXPECT_DOUBLE_EQ(round_step(0.011).length, 0.02);
  EXPECT_EQ(round_step(0.011).decimals, 2);
  EXPECT_DOUBLE_EQ(round_step(0.2).length, 0.2);
  EXPECT_DOUBLE_EQ(round_step(6).length, 10);
  EXPECT_EQ(round_step(0.07).decimals, 1);
  EXPECT_DOUBLE_EQ(rounded_up(0.27, 3), 0.3);
  EXPECT_DOUBLE_EQ(rounded_up(30, 4), 30);
  EXPECT_DOUBLE_EQ(rounded_up(kNaN, 4), 1);
  EXPECT_DOUBLE_EQ(rounded_up(0, 4), 1);
}

}  // namespace
}  // namespace milepost
