// The contents of an evaluation report: rows, marks, captions, columns and layers.
#include "client/evaluate/report/report_data.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "schema/page/report_numbers.h"
#include "tests/client/evaluate/report/page_data.h"
#include "tests/client/evaluate/report/report_input.h"

namespace milepost {
namespace {

using testing::column_of;
using ::testing::ContainsRegex;
using testing::evaluation;
using ::testing::HasSubstr;
using testing::know_lateral;
using testing::layers_of;
using ::testing::Not;
using testing::part_of;
using testing::report_input;
using testing::small_errors;
using testing::straight_drive;

Json data_of(const Drive& drive, const std::vector<MethodEvaluation>& methods) {
  return report_data(report_input(drive, methods));
}

std::string caption_of(const Json& page, const std::string& heading) {
  return part_of(page, heading)["caption"];
}

Json row_of(const Json& table, const std::string& method) {
  for (const Json& row : table["rows"]) {
    if (row["cells"][0] == method) return row;
  }
  return nullptr;
}

// The headings of the marked cells.
std::vector<std::string> marked(const Json& table, const std::string& method) {
  std::vector<std::string> headings;
  const Json row = row_of(table, method);
  for (const Json& index : row["best"]) {
    headings.push_back(table["columns"].at(index.get<std::size_t>())["heading"]);
  }
  return headings;
}

TEST(ReportData, HasARowForEachMethodWithAllItsNumbers) {
  const Drive drive = straight_drive(20);
  const Json table =
      part_of(data_of(drive, {evaluation("tracklet-regression", drive, small_errors(20, 0.2)),
                              evaluation("milepost", drive, small_errors(20, 0.05))}),
              "Summary");
  EXPECT_EQ(table["rows"].size(), 2U);
  EXPECT_EQ(row_of(table, "milepost")["cells"],
            Json::parse(R"(["milepost",0.07,0.04,0.31,0.06,0.21,20,20,94,1.3,73,76])"));
  EXPECT_EQ(table["columns"].size(), 12U);
}

TEST(ReportData, MarksTheBestOfEachColumn) {
  const Drive drive = straight_drive(20);
  MethodEvaluation near = evaluation("near", drive, small_errors(20, 0.05));
  MethodEvaluation far = evaluation("far", drive, small_errors(20, 0.2));
  far.summary.mean_error_m = 0.4;
  far.summary.std_error_m = kNaN;
  near.summary.within_2_sigma = 1;  // 95 % is the nominal share
  far.summary.latency_ms_p50 = 40;
  const Json page = data_of(drive, {far, near});
  const Json table = part_of(page, "Summary");
  EXPECT_THAT(marked(table, "near"), ::testing::ElementsAre("mean", "std"));
  EXPECT_THAT(marked(table, "far"), ::testing::ElementsAre("within 2\u03C3", "latency p50"));
  EXPECT_TRUE(row_of(table, "far")["cells"][2].is_null());
  EXPECT_THAT(table["note"].get<std::string>(), HasSubstr("is underlined"));
}

TEST(ReportData, MethodsThatSayTheBestAlikeShareTheMark) {
  const Drive drive = straight_drive(20);
  std::vector<MethodEvaluation> methods;
  for (const char* name : {"light", "slim", "heavy"}) {
    methods.push_back(evaluation(name, drive, small_errors(20, 0.05)));
  }
  methods[1].summary.map_kb_per_m += 0.001;  // less than the printed digits
  methods[2].summary.map_kb_per_m = 9;
  const Json table = part_of(data_of(drive, methods), "Summary");
  EXPECT_THAT(marked(table, "light"), ::testing::ElementsAre("map"));
  EXPECT_THAT(marked(table, "slim"), ::testing::ElementsAre("map"));
  EXPECT_THAT(marked(table, "heavy"), ::testing::IsEmpty());
}

TEST(ReportData, LateralOffsetAndHeadingAreOfTheMethodsThatKnowThem) {
  const Drive drive = straight_drive(20);
  MethodEvaluation ours = evaluation("milepost", drive, small_errors(20, 0.05));
  know_lateral(ours);
  ours.fixes[5].lateral_error_m = 0.035;  // beyond two sigma against the map, not in the world
  MethodEvaluation far = ours;
  far.summary.method = "far";
  far.fixes[3].lateral_error_m = 5;
  const Json page =
      data_of(drive, {evaluation("inverse-scale", drive, small_errors(20, 0.2)), ours, far});
  const Json table = part_of(page, "Lateral offset and heading");
  EXPECT_EQ(table["rows"].size(), 2U);
  EXPECT_EQ(row_of(table, "milepost")["cells"],
            Json::parse(R"(["milepost",0.028,0.084,0.124,67,0.29,0.85,1.23])"));
  EXPECT_THAT(page["lead"].get<std::string>(), HasSubstr("lateral offset is 0.028\u00A0m"));
  const Json figure = part_of(page, "Error of the lateral offset");
  EXPECT_EQ(layers_of(figure, "line").size(), 2U);
  const std::vector<Json> bands = layers_of(figure, "band");
  ASSERT_EQ(bands.size(), 2U);
  EXPECT_NEAR(bands[0]["y"][3].get<double>(), 0.04, 1e-9);
  EXPECT_NEAR(bands[1]["y"][3].get<double>(), 0.0286, 1e-9);  // without the map's own error
  EXPECT_THAT(figure["caption"].get<std::string>(), ContainsRegex("world.*100.0.*map.*95.0"));
  EXPECT_THAT(figure["caption"].get<std::string>(),
              ContainsRegex("errors beyond [0-9.]+\u00A0m: 1 of far\\."));
  const Json errors_m = column_of(page, layers_of(figure, "line", "far").at(0)["y"]);
  EXPECT_EQ(errors_m[3], 5);
}

TEST(ReportData, WithoutLateralOffsetNothingIsSaidOfIt) {
  const Drive drive = straight_drive(20);
  const Json page = data_of(drive, {evaluation("milepost", drive, small_errors(20, 0.05))});
  EXPECT_THAT(page.dump(), Not(HasSubstr("ateral")));
}

TEST(ReportData, HeadSaysWhatWasEvaluated) {
  const Drive drive = straight_drive(20);
  const Json page = data_of(drive, {evaluation("milepost", drive, small_errors(20, 0.05))});
  EXPECT_EQ(page["kind"], "evaluation");
  EXPECT_EQ(page["title"], "query");
  EXPECT_EQ(page["facts"], Json::parse(R"json([["Map","town (build 4f1c9a2b)"],
    ["Tiles from","http://127.0.0.1:8080"],["Driven","s1, 20.0 m"],["Captured","2011-09-30"],
    ["Frames","20 in 1.9 s, 600 × 500 pixels"],["Recording",""],["Licence",""]])json"));
  EXPECT_THAT(page["lead"].get<std::string>(), HasSubstr("Half of them are within 0.060\u00A0m"));
  EXPECT_THAT(page["lead"].get<std::string>(), HasSubstr("95\u00A0% within 0.21\u00A0m"));
}

TEST(ReportData, EveryFrameHasItsValues) {
  const Drive drive = straight_drive(4);
  MethodEvaluation ours = evaluation("milepost", drive, {0.1, kNaN, -0.25, 0.33333});
  const Json page = data_of(drive, {evaluation("other", drive, small_errors(4, 1)), ours});
  const Json& columns = page["columns"];
  EXPECT_EQ(columns["route_m"], Json::parse("[0,1,2,3]"));
  EXPECT_EQ(columns["frame"][3], "frame3.jpg");
  EXPECT_EQ(columns["1.error_m"], Json::parse("[0.1,null,-0.25,0.3333]"));
  EXPECT_EQ(columns["1.sigma_m"], Json::parse("[0.05,null,0.05,0.05]"));
  EXPECT_EQ(columns["1.matches"], Json::parse("[30,0,30,30]"));
  EXPECT_NEAR(columns["east_m"][3].get<double>(), 2.4, 1e-3);
  EXPECT_NEAR(columns["north_m"][3].get<double>(), 1.8, 1e-3);
  const Json told = page["frames"]["rows"][1];
  EXPECT_EQ(told["name"], "milepost");
  EXPECT_EQ(told["values"][0]["column"], "1.error_m");
  const Json status = told["values"].back();
  EXPECT_EQ(status["words"][columns["1.status"][1].get<std::size_t>()], "lost");
  EXPECT_EQ(status["words"][columns["1.status"][2].get<std::size_t>()], "tracking");
}

TEST(ReportData, OutliersAreCountedInWordsAndDoNotStretchTheScale) {
  const Drive drive = straight_drive(100);
  std::vector<double> errors_m = small_errors(100, 0.1);
  errors_m[10] = 50;
  errors_m[20] = errors_m[30] = -50;
  const Json page = data_of(drive, {evaluation("milepost", drive, errors_m)});
  const Json errors = part_of(page, "Error along the route");
  EXPECT_LT(errors["plots"][0]["y"]["max"].get<double>(), 1);
  EXPECT_THAT(errors["caption"].get<std::string>(), HasSubstr("3 of milepost"));
  const Json histogram = part_of(page, "Errors by size");
  EXPECT_EQ(layers_of(histogram, "texts").at(0)["text"][0], "\u25C2 2 further");
  EXPECT_EQ(layers_of(histogram, "texts").at(1)["text"][0], "1 further \u25B8");
  EXPECT_THAT(histogram["caption"].get<std::string>(),
              ContainsRegex("Not drawn: below \u22120\\.[0-9]+\u00A0m lie 2 of milepost; above "
                            "0\\.[0-9]+\u00A0m lie 1 of milepost"));
}

TEST(ReportData, WithoutOutliersSaysThatNoneIsLeftOut) {
  const Drive drive = straight_drive(100);
  const Json page = data_of(drive, {evaluation("milepost", drive, small_errors(100, 0.1))});
  EXPECT_THAT(caption_of(page, "Errors by size"), HasSubstr("No error is omitted."));
  EXPECT_THAT(layers_of(part_of(page, "Errors by size"), "texts"), ::testing::IsEmpty());
}

TEST(ReportData, TheHistogramHoldsAllErrorsAndTheCumulativeShareEndsAtAll) {
  const Drive drive = straight_drive(100);
  const Json page = data_of(drive, {evaluation("milepost", drive, small_errors(100, 0.1))});
  double sum = 0;
  const Json histogram = layers_of(part_of(page, "Errors by size"), "line", "milepost").at(0);
  for (const Json& share : histogram["y"]) sum += share.get<double>();
  EXPECT_NEAR(sum, 100, 0.1);
  EXPECT_EQ(histogram["x"].size(), histogram["y"].size());
  const Json shares =
      layers_of(part_of(page, "Frames within an error"), "line", "milepost").at(0)["y"];
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_EQ(shares.back(), 100);
}

TEST(ReportData, ErrorsOfOneSizeHaveNoNormalDistribution) {
  const Drive drive = straight_drive(4);
  const auto lines = [&](const std::vector<double>& errors_m) {
    const Json page = data_of(drive, {evaluation("milepost", drive, errors_m)});
    return layers_of(part_of(page, "Errors by size"), "line").size();
  };
  EXPECT_EQ(lines({0.1, 0.1, 0.1, 0.1}), 1U);
  EXPECT_EQ(lines({0.1, -0.1, 0.05, -0.05}), 2U);
}

TEST(ReportData, StretchesThatWereNotTrackedLieInLanes) {
  const Drive drive = straight_drive(6);
  const Json page =
      data_of(drive, {evaluation("milepost", drive, {0.1, kNaN, kNaN, 0.1, 0.1, kNaN})});
  const Json figure = part_of(page, "Error along the route");
  EXPECT_EQ(figure["plots"][0]["lanes"],
            Json::parse(R"([{"colour":"m0","marks":[[1,2,"lost"],[5,5,"lost"]]}])"));
  EXPECT_THAT(figure["caption"].get<std::string>(), HasSubstr("3 tracking and 3 lost."));
}

TEST(ReportData, OverSeveralSegmentsTheRouteIsTheDistanceDriven) {
  const Drive drive = straight_drive(8);
  MethodEvaluation method = evaluation("milepost", drive, small_errors(8, 0.1));
  method.fixes[3].frame.fix.segment = "s2";
  const Json page = data_of(drive, {method});
  EXPECT_EQ(page["frames"]["label"], "distance driven");
  EXPECT_NEAR(page["columns"]["route_m"][7].get<double>(), 7, 1e-3);
  EXPECT_THAT(caption_of(data_of(straight_drive(5), {method}), "Error along the route"),
              HasSubstr("3 frames without a true position"));
}

TEST(ReportData, ThePlanIsOfOneScaleAndHasADotAFix) {
  const Drive drive = straight_drive(101);  // 80 m east, 60 m north
  std::vector<double> errors_m = small_errors(101, 0.04);
  errors_m[7] = kNaN;
  errors_m[9] = 0.3;
  const Json page = data_of(drive, {evaluation("milepost", drive, errors_m)});
  const Json figure = part_of(page, "On the map");
  const Json plot = figure["plots"][0];
  EXPECT_TRUE(plot["plan"].get<bool>());
  EXPECT_GT(plot["x"]["max"].get<double>() - plot["x"]["min"].get<double>(), 80);
  EXPECT_GT(plot["y"]["max"].get<double>() - plot["y"]["min"].get<double>(), 60);
  EXPECT_EQ(layers_of(figure, "dots", "error up to 0.05 m").at(0)["x"].size(), 99U);
  EXPECT_EQ(layers_of(figure, "dots", "up to 0.5 m").at(0)["x"].size(), 1U);
  const Json without = layers_of(figure, "dots", "frame without a fix").at(0);
  EXPECT_NEAR(without["x"][0].get<double>(), 0.8 * 7, 1e-2);
  EXPECT_NEAR(without["y"][0].get<double>(), 0.6 * 7, 1e-2);
}

TEST(ReportData, ThePlanHasTheNetworkAndItsJunctions) {
  const Drive drive = straight_drive(20);
  ReportInput input = report_input(drive, {evaluation("milepost", drive, small_errors(20, 0.04))});
  RoadAround exit = input.roads.front();
  exit.segment.segment = "s2";
  exit.is_driven = false;
  exit.line.resize(5);
  input.roads.push_back(exit);
  input.roads.front().ends_at_junction = true;
  const Json page = report_data(input);
  const Json figure = part_of(page, "On the map");
  EXPECT_EQ(page["facts"][2], Json::parse(R"(["Driven","s1, 20.0 m"])"));
  const Json driven = layers_of(figure, "line", "segment driven").at(0);
  EXPECT_EQ(driven["x"].size(), 21U);
  EXPECT_TRUE(driven["x"].back().is_null());  // no line leads to the next segment
  EXPECT_EQ(layers_of(figure, "line", "other segment").at(0)["x"].size(), 6U);
  const Json junctions = layers_of(figure, "dots", "ways part or join").at(0);
  EXPECT_EQ(junctions["x"], Json::array({driven["x"][19]}));
  input.roads.back().is_driven = true;
  EXPECT_EQ(report_data(input)["facts"][2], Json::parse(R"(["Driven","2 segments, 40.0 m"])"));
}

TEST(ReportData, FixesOnAWrongSegmentAreSaidFirst) {
  const Drive drive = straight_drive(20);
  MethodEvaluation method = evaluation("milepost", drive, small_errors(20, 0.04));
  EXPECT_THAT(data_of(drive, {method})["lead"].get<std::string>(), Not(HasSubstr("wrong")));
  method.summary.wrong_segment_frames = 3;
  EXPECT_THAT(data_of(drive, {method})["lead"].get<std::string>(),
              HasSubstr("milepost placed 20 of 20 frames on the map, 3 on a wrong segment."));
}

TEST(ReportData, PositionsThatAreNoneLeaveThePlanAsItIs) {
  Drive drive = straight_drive(101);
  const ReportInput input =
      report_input(drive, {evaluation("milepost", drive, std::vector<double>(101, kNaN))});
  const auto axis_of = [&] { return part_of(report_data(input), "On the map")["plots"][0]["x"]; };
  const Json before = axis_of();
  drive.frames[50].position.altitude_m = std::numeric_limits<double>::infinity();
  drive.frames[51].position.latitude_deg = 200;
  EXPECT_EQ(axis_of(), before);
  for (Frame& frame : drive.frames) frame.position.latitude_deg = 200;
  EXPECT_GT(axis_of()["max"].get<double>(), 80);  // only the segment's line is left
}

TEST(ReportData, AMethodHasItsColourWhateverStandsBesideIt) {
  const Drive drive = straight_drive(10);
  const auto colours_of = [&](const std::vector<const char*>& names) {
    std::vector<MethodEvaluation> methods;
    methods.reserve(names.size());
    for (const char* name : names) {
      methods.push_back(evaluation(name, drive, small_errors(10, 0.1)));
    }
    const Json page = data_of(drive, methods);
    std::vector<std::string> colours;
    for (const Json& row : page["frames"]["rows"]) colours.push_back(row["colour"]);
    return colours;
  };
  EXPECT_THAT(colours_of({"wisurf", "milepost", "scale-only"}),
              ::testing::ElementsAre("m6", "m0", "m5"));
  EXPECT_THAT(colours_of({"scale-only", "inverse-scale"}), ::testing::ElementsAre("m5", "m8"));
  EXPECT_THAT(colours_of({"mine", "milepost", "yours"}), ::testing::ElementsAre("m1", "m0", "m2"));
}

TEST(ReportData, AMethodThatMatchesNothingIsNotAmongTheMatches) {
  const Drive drive = straight_drive(10);
  MethodEvaluation of_images = evaluation("wisurf", drive, small_errors(10, 0.1));
  for (EvaluatedFix& fix : of_images.fixes) fix.frame.fix.matches = 0;
  const Json figure =
      part_of(data_of(drive, {of_images, evaluation("milepost", drive, small_errors(10, 0.1))}),
              "Matches per frame");
  EXPECT_EQ(layers_of(figure, "line").size(), 1U);
  EXPECT_GE(figure["plots"][0]["y"]["max"].get<double>(), 30);  // the largest is inside
}

// Inputs with hardly anything to draw.
struct EdgeCase {
  const char* name;
  std::vector<double> errors_m;
};

class ReportDataOf : public ::testing::TestWithParam<EdgeCase> {};

TEST_P(ReportDataOf, HasAllFiguresAndAxesOfSomeLength) {
  const Drive drive = straight_drive(GetParam().errors_m.size());
  MethodEvaluation method = evaluation("milepost", drive, GetParam().errors_m);
  if (method.summary.localized_frames == 0) {
    method.summary.mean_error_m = method.summary.p50_error_m = kNaN;
    method.summary.within_2_sigma = kNaN;
  }
  std::size_t figures = 0;
  for (const Json& part : testing::parts_of(data_of(drive, {method}))) {
    if (part["part"] != "figure") continue;
    ++figures;
    for (const Json& plot : part["plots"]) {
      for (const char* which : {"x", "y"}) {
        EXPECT_LT(plot[which]["min"].get<double>(), plot[which]["max"].get<double>())
            << part["heading"] << which;
      }
    }
  }
  EXPECT_EQ(figures, 6U);
}

INSTANTIATE_TEST_SUITE_P(Edges, ReportDataOf,
                         ::testing::Values(EdgeCase{"NoFrame", {}}, EdgeCase{"OneFrame", {0.1}},
                                           EdgeCase{"OneLostFrame", {kNaN}},
                                           EdgeCase{"NothingLocalized", {kNaN, kNaN, kNaN}},
                                           EdgeCase{"NoError", {0, 0, 0, 0}},
                                           EdgeCase{"OneOfManyLocalized", {kNaN, kNaN, 0.2, kNaN}},
                                           EdgeCase{"OneSizeOfError", {0.1, 0.1, 0.1, 0.1}}),
                         [](const auto& tested) { return tested.param.name; });

TEST(ReportData, WithoutDriveMethodsOrPositionsIsStillAPage) {
  const Drive drive = straight_drive(4);
  Drive nowhere = drive;
  for (Frame& frame : nowhere.frames) frame.position.longitude_deg = kNaN;
  const MethodEvaluation method = evaluation("milepost", drive, {0.1, 0.2, 0.3, 0.4});
  ReportInput no_drive = report_input(drive, {method});
  no_drive.drive = nullptr;
  ReportInput no_line = no_drive;
  no_line.roads.clear();
  ReportInput lost_positions = report_input(drive, {method});
  lost_positions.drive = &nowhere;
  for (const ReportInput& input :
       {ReportInput{}, report_input(drive, {}), no_drive, no_line, lost_positions}) {
    const Json page = report_data(input);
    EXPECT_TRUE(page["parts"].is_array());
    EXPECT_FALSE(page["title"].get<std::string>().empty());
  }
  EXPECT_EQ(report_data(ReportInput{})["lead"], "No method was evaluated.");
}

TEST(ReportData, WhereNothingIsKnownNothingIsDrawn) {
  const Drive drive = straight_drive(4);
  MethodEvaluation method = evaluation("milepost", drive, {kNaN, kNaN, kNaN, kNaN});
  const auto empty_figures = [](const Json& page) {
    const std::vector<Json> parts = testing::parts_of(page);
    return std::count_if(parts.begin(), parts.end(), [](const Json& part) {
      return part["part"] == "figure" && part["plots"].empty();
    });
  };
  const Json page = data_of(drive, {method});
  EXPECT_EQ(page["lead"], "milepost placed none of 4 frames on the map.");
  EXPECT_EQ(empty_figures(page), 2);  // histogram and cumulative share
  for (EvaluatedFix& fix : method.fixes) fix.truth_along_m = std::nullopt;
  ReportInput input = report_input(drive, {method});
  input.drive = nullptr;
  input.roads.clear();
  EXPECT_EQ(empty_figures(report_data(input)), 6);
}

}  // namespace
}  // namespace milepost
