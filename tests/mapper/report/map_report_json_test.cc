#include "mapper/report/map_report_json.h"

#include <gmock/gmock.h>

#include <set>

#include "schema/page/report_page.h"
#include "tests/mapper/report/made_up_map.h"

namespace milepost {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::made_up_report;
using testing::MadeUpSegment;

Json part_named(const Json& page, const std::string& kind) {
  for (const Json& part : page["parts"]) {
    if (part["part"] == kind) return part;
  }
  return nullptr;
}

Json part_headed(const Json& page, const std::string& heading) {
  for (const Json& part : page["parts"]) {
    if (part.value("heading", "") == heading) return part;
  }
  return nullptr;
}

std::string fact_of(const Json& page, const std::string& name) {
  for (const Json& fact : page["facts"]) {
    if (fact[0] == name) return fact[1];
  }
  return "no such fact";
}

MappingRecord some_record() {
  MappingRecord record;
  StretchFit fit;
  fit.from_m = 20;
  fit.to_m = 30;
  fit.drive = "monday";
  fit.fit.followed = 200;
  fit.fit.fitting = 150;
  record.segments["monday-0"] = {fit};
  record.drives = {{"monday", {80, 5000, 4500, 0.7, 0.03, 0.02, 0.1}}};
  record.findings = {
      {"noise", "monday", "trajectory.csv", "positions are noisy", "smooth them", 3, 7}};
  return record;
}

TEST(MapReportJson, EachColumnHasAValueForEachStretch) {
  MadeUpSegment other;
  other.id = "tuesday-0";
  other.east_m = 30;
  const Json page = map_report_json(made_up_report({{}, other}));
  for (const auto& [name, values] : page["columns"].items()) {
    if (name == "way_east_m" || name == "way_north_m") continue;
    EXPECT_EQ(values.size(), 12U) << name;
  }
  std::size_t points = 0;
  for (const Json& count : page["columns"]["way_points"]) points += count.get<std::size_t>();
  EXPECT_EQ(page["columns"]["way_east_m"].size(), points);
  ASSERT_EQ(page["segments"].size(), 2U);
  EXPECT_EQ(page["segments"][1]["first"], 6);
  EXPECT_EQ(page["segments"][1]["end"], 12);
}

TEST(MapReportJson, ThePlanIsAboutTheMapsCentre) {
  const Json page = map_report_json(made_up_report({{}}));
  const Json& north = page["columns"]["way_north_m"];
  EXPECT_NEAR(north.front().get<double>(), -28.5, 0.1);
  EXPECT_NEAR(north.back().get<double>(), 28.5, 0.1);
  const Json plot = part_named(page, "plan")["plot"];
  EXPECT_LT(plot["y"]["min"].get<double>(), -28.5);
  EXPECT_GT(plot["y"]["max"].get<double>(), 28.5);
}

TEST(MapReportJson, ColoursAreVariablesOfTheStyle) {
  const std::string page = report_page(map_report_json(made_up_report({{}})));
  std::set<std::string> colours;
  const Json data = map_report_json(made_up_report({{}}));
  for (const Json& view : data["views"]) {
    for (const Json& each : view["classes"]) colours.insert(each["colour"]);
  }
  EXPECT_EQ(colours.size(), 10U);
  for (const std::string& colour : colours) {
    const std::size_t light = page.find("--" + colour + ": #");
    ASSERT_NE(light, std::string::npos) << colour;
    EXPECT_NE(page.find("--" + colour + ": #", light + 1), std::string::npos) << colour;  // dark
  }
}

TEST(MapReportJson, TheHeadTellsTheFacts) {
  MadeUpSegment known;
  known.id = "tuesday-0";
  known.east_m = 30;
  known.position_error = {0.05, 200.0, false};
  known.passes = {{"tuesday", 0, 57}, {"monday", 9, 66}};
  known.landmark_passes = 2;
  const Json page = map_report_json(made_up_report({{}, known}));
  EXPECT_EQ(page["title"], "town");
  EXPECT_EQ(page["kind"], "map");
  EXPECT_EQ(fact_of(page, "Length"), "114\u00A0m");
  EXPECT_EQ(fact_of(page, "Segments"), "2");
  EXPECT_EQ(fact_of(page, "Drives"), "2");
  EXPECT_EQ(fact_of(page, "Landmarks a metre"), "4.0");
  EXPECT_EQ(fact_of(page, "Map positions known to"),
            "0.050 to 0.180\u00A0m, assumed on 50\u00A0% of the road");
  EXPECT_EQ(fact_of(page, "Seen by two drives or more"), "50\u00A0% of the landmarks");
  EXPECT_EQ(fact_of(page, "Build").size(), 32U);
}

TEST(MapReportJson, WhatNeedsALookComesFirst) {
  MadeUpSegment gap;
  gap.id = "tuesday-0";
  gap.east_m = 30;
  gap.mapped = {{0, 20}};
  MadeUpSegment longer_gap = gap;
  longer_gap.id = "wednesday-0";
  longer_gap.mapped = {};
  const Json page = map_report_json(made_up_report({{}, gap, longer_gap}));
  EXPECT_THAT(part_named(page, "strips")["order"], ElementsAre(2, 1, 0));
  EXPECT_THAT(std::string(page["lead"]), HasSubstr("too few landmarks"));
  EXPECT_EQ(page["columns"]["gap"].back(), 1);
  EXPECT_EQ(page["columns"]["world_class"].back(), nullptr);
}

TEST(MapReportJson, WithoutARecordItSaysSo) {
  const Json page = map_report_json(made_up_report({{}}));
  EXPECT_EQ(part_headed(page, "Findings of the build")["part"], "note");
  EXPECT_THAT(std::string(part_headed(page, "Findings of the build")["text"]),
              HasSubstr("not record"));
  EXPECT_EQ(part_headed(page, "The drives")["columns"].size(), 3U);
  EXPECT_EQ(part_named(page, "segment")["plots"].size(), 3U);
  for (const Json& each : page["columns"]["fit_class"]) EXPECT_EQ(each, nullptr);
}

TEST(MapReportJson, WhatWasRecordedIsShown) {
  const Json page = map_report_json(made_up_report({{}}, some_record()));
  EXPECT_EQ(page["columns"]["fit_percent"][2], 75);
  EXPECT_EQ(page["columns"]["fit_class"][2], 2);
  EXPECT_EQ(page["columns"]["worst_fit_drive"][2], 0);
  EXPECT_EQ(page["columns"]["fit_percent"][3], nullptr);
  EXPECT_EQ(part_named(page, "segment")["plots"].size(), 4U);
  const Json findings = part_headed(page, "Findings of the build");
  EXPECT_EQ(findings["rows"][0]["cells"].dump(),
            R"(["noise","monday","trajectory.csv, row 3","positions are noisy; smooth them",7])");
  EXPECT_EQ(part_headed(page, "The drives")["rows"][0]["cells"].dump(),
            R"(["monday",1,57,80,5000,90,0.7,0.03,0.02,0.1])");
}

TEST(MapReportJson, SurveyedMarksAreATableAndOnThePlan) {
  MappingRecord record;
  CheckPointResidual placed{"B7", "monday", 49, 8.4, 110, 12, true, 0.03, -0.04, 0.01, 0.6};
  CheckPointResidual unplaced{"B7", "tuesday", 49, 8.4, 110, 1};
  record.check_points = {placed, unplaced};
  const Json page = map_report_json(made_up_report({{}}, record));
  const Json table = part_headed(page, "Surveyed marks");
  EXPECT_EQ(table["rows"][0]["cells"].dump(), R"(["B7","monday",12,0.05,0.03,-0.04,0.01,0.6])");
  EXPECT_EQ(table["rows"][1]["cells"].dump(), R"(["B7","tuesday",1,null,null,null,null,null])");
  const Json layers = part_named(page, "plan")["plot"]["layers"];
  const Json& marks = layers.at(layers.size() - 2);
  EXPECT_EQ(marks["name"], "surveyed mark");
  ASSERT_EQ(marks["x"].size(), 1U);
  EXPECT_NEAR(marks["y"][0].get<double>(), -28.5, 0.1);
  EXPECT_TRUE(part_headed(map_report_json(made_up_report({{}})), "Surveyed marks").is_null());
}

TEST(MapReportJson, NamesStayTexts) {
  MapReportData data = made_up_report({{}}, some_record());
  const std::string hostile = "</script><img src=x onerror=alert(1)>";
  data.segments[0].inspected.stored.id = hostile;
  data.drives[0].name = hostile;
  data.findings->front().what = hostile;
  const std::string page = report_page(map_report_json(data));
  EXPECT_EQ(page.find("<img"), std::string::npos);
  EXPECT_NE(page.find("\\u003c/script>\\u003cimg src=x"), std::string::npos);
}

TEST(MapReportJson, AMapWithoutSegmentsHasAPage) {
  const Json page = map_report_json(made_up_report({}));
  EXPECT_EQ(page["lead"], "The map has no segments.");
  EXPECT_FALSE(report_page(page).empty());
}

TEST(MapReportJson, IsTheSameEachTimeAndSmall) {
  std::vector<MadeUpSegment> many;
  for (int i = 0; i < 200; ++i) {
    MadeUpSegment segment;
    segment.id = "drive-" + std::to_string(100 * i);
    segment.east_m = 10 * i;
    many.push_back(segment);
  }
  const MapReportData data = made_up_report(many);
  const std::string page = report_page(map_report_json(data));
  EXPECT_EQ(page, report_page(map_report_json(data)));
  EXPECT_LT(page.size(), 1'000'000U);
}

}  // namespace
}  // namespace milepost
