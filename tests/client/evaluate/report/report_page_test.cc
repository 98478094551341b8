// The page of an evaluation: strings stay strings.
#include "schema/page/report_page.h"

#include <gmock/gmock.h>

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

std::string embedded(const std::string& page) {
  const std::string opening = R"(<script type="application/json" id="data">)";
  const std::size_t start = page.find(opening) + opening.size();
  return page.substr(start, page.find("</script>", start) - start);
}

TEST(EvaluationPage, NamesCannotBecomeMarkup) {
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

TEST(EvaluationPage, IsTheSameEachTime) {
  const Drive drive = straight_drive(50);
  const ReportInput input =
      report_input(drive, {evaluation("tracklet-regression", drive, small_errors(50, 0.3)),
                           evaluation("milepost", drive, small_errors(50, 0.05))});
  EXPECT_EQ(report_page(report_data(input)), report_page(report_data(input)));
}

TEST(EvaluationPage, OfALongDriveByAllMethodsStaysSmall) {
  const Drive drive = straight_drive(2000);
  std::vector<MethodEvaluation> methods;
  for (const char* name :
       {"wisurf", "scale-only", "tracklet-matching", "tracklet-regression",
        "tracklet-regression-kalman", "tracklet-regression-particle", "milepost"}) {
    methods.push_back(evaluation(name, drive, small_errors(2000, 0.3)));
  }
  EXPECT_LT(report_page(report_data(report_input(drive, methods))).size(), 1'500'000U);
}

}  // namespace
}  // namespace milepost
