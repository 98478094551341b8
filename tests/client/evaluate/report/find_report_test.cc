// The report of a found drive that is made up, so that a test knows what must be told and drawn.
#include "client/evaluate/report/find_report.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <regex>

#include "schema/base/file.h"
#include "tests/client/evaluate/found_run.h"
#include "tests/support/temp_folder.h"

namespace milepost {
namespace {

using testing::FoundRun;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

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

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++count;
  }
  return count;
}

TEST(FindReport, TellsTheFigures) {
  const std::string html = find_report_html(FoundRun(40, 10).input());
  EXPECT_TRUE(is_well_formed(html));
  EXPECT_THAT(html, HasSubstr("Found after 1.0 s, and tracked in 30 of 40 frames."));
  EXPECT_THAT(html, HasSubstr("<dd>75.0\u00A0%"));
  EXPECT_THAT(html, HasSubstr(R"(<td data-label="p95" data-unit="m">2.00</td>)"));
  EXPECT_THAT(html, HasSubstr(R"(<td data-label="mean" data-unit="°">3.00</td>)"));
  EXPECT_EQ(count_of(html, "href=\"#ground\""), 7U);  // six snapshots and the path
  EXPECT_EQ(count_of(html, "id=\"ground\""), 1U);
}

TEST(FindReport, AVehicleThatIsNeverFoundIsToldOf) {
  const std::string html = find_report_html(FoundRun(5, 5).input());
  EXPECT_TRUE(is_well_formed(html));
  EXPECT_THAT(html, HasSubstr("The vehicle was not found in 5 frames."));
  EXPECT_THAT(html, HasSubstr("<dd>never</dd>"));
}

TEST(FindReport, FramesInAWrongPlaceAreToldOf) {
  FoundRun run(40, 10);
  EXPECT_THAT(find_report_html(run.input()), Not(HasSubstr("wrong place")));
  for (std::size_t i : {5U, 20U, 21U}) {
    const LocalFrame here(run.drive.frames[i].position);
    run.found[i].fix.position = here.geo_from_enu({50, 0, 0});
  }
  EXPECT_THAT(find_report_html(run.input()),
              HasSubstr("In 2 frames it was taken to be in a wrong place, more than 10 m off."));
}

TEST(FindReport, IsTheSameEachTime) {
  EXPECT_EQ(find_report_html(FoundRun(30, 10).input()), find_report_html(FoundRun(30, 10).input()));
}

TEST(FindReport, WithoutRecordedPositionsNoErrorIsToldOrDrawn) {
  FoundRun run(20, 5);
  for (Frame& frame : run.drive.frames) frame.position.latitude_deg = kNaN;
  const std::string html = find_report_html(run.input());
  EXPECT_TRUE(is_well_formed(html));
  const std::string body = html.substr(html.find("<body>"));
  EXPECT_FALSE(std::regex_search(body, std::regex(R"(\b-?(nan|inf)\b)", std::regex::icase)));
  EXPECT_THAT(html, HasSubstr("There is nothing to draw"));
  EXPECT_THAT(html, HasSubstr("tracked in 15 of 20 frames.</p>"));
}

TEST(FindReport, NamesCannotBeMarkup) {
  FoundRun run(3, 1);
  run.drive.name = "<script>";
  EXPECT_THAT(find_report_html(run.input()), Not(HasSubstr("<script>")));
}

TEST(FindReport, ABackdropLiesOnceBeneathAllPlans) {
  const FoundRun run(20, 5);
  FindReportInput input = run.input();
  EXPECT_THAT(find_report_html(input), Not(HasSubstr("<image")));
  // The walls' box, 223 m from south to north about its origin.
  input.backdrop = Backdrop{cv::Mat(200, 200, CV_8UC3, cv::Scalar(90, 90, 90)),
                            {1e-5, 0, 0, -1e-5, 8.399005, 49.000995}};
  const std::string html = find_report_html(input);
  EXPECT_TRUE(is_well_formed(html));
  EXPECT_EQ(count_of(html, "data:image/jpeg;base64,/9j/"), 1U);  // a JPEG's first bytes
  std::smatch match;
  ASSERT_TRUE(std::regex_search(html, match, std::regex(R"(<image[^>]*matrix\(([^)]*)\))")));
  std::istringstream numbers(match[1]);
  double right_x = 0, right_y = 0, down_x = 0, down_y = 0, x = 0, y = 0;
  numbers >> right_x >> right_y >> down_x >> down_y >> x >> y;
  EXPECT_NEAR(right_x, 146.3, 0.2);
  EXPECT_NEAR(down_y, 222.4, 0.2);
  EXPECT_NEAR(x, -right_x / 2, 0.1);
  EXPECT_NEAR(y, -down_y / 2, 0.1);
}

TEST(FindReport, OfABackdropOnlyWhatPlansShowIsInThePage) {
  const FoundRun run(20, 5);
  FindReportInput input = run.input();
  // A town of 20 by 20 km about the walls, and one beside them.
  const cv::Mat town(2000, 2000, CV_8UC3, cv::Scalar(90, 90, 90));
  input.backdrop = Backdrop{town, {1e-4, 0, 0, -1e-4, 8.3, 49.1}};
  EXPECT_EQ(count_of(find_report_html(input), "<image"), 1U);
  EXPECT_LT(find_report_html(input).size(), 400'000U);
  input.backdrop = Backdrop{town, {1e-4, 0, 0, -1e-4, 8.6, 49.1}};
  EXPECT_EQ(count_of(find_report_html(input), "<image"), 0U);
}

TEST(FindReport, ALongDriveStaysSmall) {
  EXPECT_LT(find_report_html(FoundRun(3000, 100).input()).size(), 1'500'000U);
}

}  // namespace
}  // namespace milepost
