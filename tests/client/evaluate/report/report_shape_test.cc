// How the report is drawn: sizes, colours, the plan view's proportions.
#include <gmock/gmock.h>

#include <algorithm>
#include <limits>
#include <regex>

#include "client/evaluate/report/report.h"
#include "tests/client/evaluate/report/report_input.h"

namespace milepost {
namespace {

using testing::evaluation;
using ::testing::HasSubstr;
using testing::report_input;
using testing::small_errors;
using testing::straight_drive;

// The numbers that a pattern's groups capture at its first match.
std::vector<double> captured(const std::string& text, const std::string& pattern) {
  std::smatch match;
  std::vector<double> numbers;
  if (!std::regex_search(text, match, std::regex(pattern))) return numbers;
  for (std::size_t i = 1; i < match.size(); ++i) numbers.push_back(std::stod(match[i]));
  return numbers;
}

TEST(ReportShape, ThePlanViewIsToScale) {
  const Drive drive = straight_drive(101);  // 80 m east, 60 m north
  const std::string html =
      report_html(report_input(drive, {evaluation("milepost", drive, small_errors(101, 0.1))}));
  const std::string plan = html.substr(html.find("class=\"chart plan\""));
  const auto shape = captured(plan, "aspect-ratio:([0-9]+)/([0-9]+)");
  const std::string ring =
      R"(<circle class="ring" r="5.0" cx="([0-9.]+)%" cy="([0-9.]+)%"><title>)";
  const auto start = captured(plan, ring + "start");
  const auto end = captured(plan, ring + "end");
  ASSERT_EQ(shape.size(), 2U);
  ASSERT_EQ(start.size(), 2U);
  ASSERT_EQ(end.size(), 2U);
  const double east = (end[0] - start[0]) * shape[0];
  const double north = (start[1] - end[1]) * shape[1];
  EXPECT_GT(east, 0);
  EXPECT_NEAR(north / east, 0.75, 0.001);
}

TEST(ReportShape, APositionThatIsNoneLeavesThePlanViewAsItIs) {
  Drive drive = straight_drive(101);
  const MethodEvaluation method = evaluation("milepost", drive, small_errors(101, 0.1));
  const auto shape_of = [&] {
    const std::string html = report_html(report_input(drive, {method}));
    return captured(html.substr(html.find("class=\"chart plan\"")),
                    "aspect-ratio:([0-9]+)/([0-9]+)");
  };
  const auto shape = shape_of();
  drive.frames[50].position.altitude_m = std::numeric_limits<double>::infinity();
  drive.frames[51].position.latitude_deg = 200;
  EXPECT_EQ(shape_of(), shape);
}

TEST(ReportShape, WithoutRecordedPositionsThePlanViewShowsTheSegment) {
  Drive drive = straight_drive(101);
  ReportInput input = report_input(
      drive, {evaluation("milepost", drive,
                         std::vector<double>(101, std::numeric_limits<double>::quiet_NaN()))});
  for (Frame& frame : drive.frames) frame.position.latitude_deg = 200;
  const std::string html = report_html(input);
  const std::string plan = html.substr(html.find("class=\"chart plan\""));
  EXPECT_THAT(plan.substr(0, plan.find("<figcaption>")), HasSubstr(">80</text>"));
}

TEST(ReportShape, TheGreatestValueLiesInsideThePlot) {
  const Drive drive = straight_drive(10);  // 30 matches a frame
  const std::string html =
      report_html(report_input(drive, {evaluation("milepost", drive, small_errors(10, 0.1))}));
  const std::string matches = html.substr(html.find("<h2>Matches per frame</h2>"));
  EXPECT_THAT(matches.substr(0, matches.find("<figcaption>")), HasSubstr(">40</text>"));
}

TEST(ReportShape, AMethodHasItsColourWhateverStandsBesideIt) {
  const Drive drive = straight_drive(10);
  const auto errors_m = small_errors(10, 0.1);
  const auto legend_of = [&](const std::vector<const char*>& names) {
    std::vector<MethodEvaluation> methods;
    methods.reserve(names.size());
    for (const char* name : names) methods.push_back(evaluation(name, drive, errors_m));
    return report_html(report_input(drive, methods));
  };
  for (const std::string& html : {legend_of({"wisurf", "milepost", "scale-only"}),
                                  legend_of({"scale-only", "wisurf", "milepost"})}) {
    EXPECT_THAT(html, HasSubstr("<span class=\"m6\"><i></i>wisurf</span>"));
    EXPECT_THAT(html, HasSubstr("<span class=\"m0\"><i></i>milepost</span>"));
    EXPECT_THAT(html, HasSubstr("<span class=\"m5\"><i></i>scale-only</span>"));
  }
  EXPECT_THAT(legend_of({"inverse-scale", "milepost"}),
              HasSubstr("<span class=\"m8\"><i></i>inverse-scale</span>"));
  const std::string html = legend_of({"mine", "milepost", "yours"});
  EXPECT_THAT(html, HasSubstr("<span class=\"m1\"><i></i>mine</span>"));
  EXPECT_THAT(html, HasSubstr("<span class=\"m2\"><i></i>yours</span>"));
}

TEST(ReportShape, AMethodThatMatchesNothingIsNotAmongTheMatches) {
  const Drive drive = straight_drive(10);
  MethodEvaluation of_images = evaluation("wisurf", drive, small_errors(10, 0.1));
  for (EvaluatedFix& fix : of_images.fixes) fix.frame.fix.matches = 0;
  const std::string html = report_html(
      report_input(drive, {of_images, evaluation("milepost", drive, small_errors(10, 0.1))}));
  const std::string matches = html.substr(html.find("<h2>Matches per frame</h2>"));
  const std::string figure = matches.substr(0, matches.find("</figure>"));
  EXPECT_THAT(figure, HasSubstr("<i></i>milepost</span>"));
  EXPECT_THAT(figure, Not(HasSubstr("wisurf")));
}

TEST(ReportShape, ALongDriveByAllMethodsStaysSmall) {
  const Drive drive = straight_drive(2000);
  std::vector<MethodEvaluation> methods;
  for (const char* name :
       {"wisurf", "scale-only", "tracklet-matching", "tracklet-regression",
        "tracklet-regression-kalman", "tracklet-regression-particle", "milepost"}) {
    methods.push_back(evaluation(name, drive, small_errors(2000, 0.3)));
  }
  EXPECT_LT(report_html(report_input(drive, methods)).size(), 1'500'000U);
}

TEST(ReportShape, EveryPointOfAShortDriveIsDrawn) {
  const Drive drive = straight_drive(30);
  const std::string html =
      report_html(report_input(drive, {evaluation("milepost", drive, small_errors(30, 0.1))}));
  const std::size_t dots = html.find(R"(<path class="m0 dots" d=")");
  ASSERT_NE(dots, std::string::npos);
  const std::string path = html.substr(dots, html.find("/>", dots) - dots);
  EXPECT_EQ(std::count(path.begin(), path.end(), 'M'), 30);
  EXPECT_EQ(captured(path, R"(d="M([0-9]+) )").at(0), 0);  // the first frame at the left end
  EXPECT_EQ(captured(path, R"(M([0-9]+) [0-9]+h1"$)").at(0), 10000);  // the last at the right
}

}  // namespace
}  // namespace milepost
