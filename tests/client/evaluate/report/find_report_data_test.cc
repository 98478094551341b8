// The report of an invented global localization run, so that a test knows the expected contents.
#include "client/evaluate/report/find_report_data.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "client/evaluate/report/find_report_figures.h"
#include "schema/page/report_numbers.h"
#include "schema/page/report_page.h"
#include "tests/client/evaluate/found_run.h"
#include "tests/client/evaluate/report/page_data.h"

namespace milepost {
namespace {

using testing::FoundRun;
using ::testing::HasSubstr;
using testing::layers_of;
using ::testing::Not;
using testing::part_of;

// The figures of a run; modify the run before they are created.
struct Drawn {
  explicit Drawn(const FoundRun& run) : input(run.input()), series(found_series(input)) {}
  Drawn(const Drawn&) = delete;
  Drawn& operator=(const Drawn&) = delete;

  Json snapshot(std::size_t number) const { return json_of(snapshot_figures(series).at(number)); }
  Json position_error() const { return json_of(position_error_figure(series)); }

  FindReportInput input;
  FoundSeries series;
};

TEST(FindReportData, TellsTheFigures) {
  const Json page = find_report_data(FoundRun(40, 10).input());
  EXPECT_EQ(page["kind"], "find");
  EXPECT_THAT(page["lead"].get<std::string>(),
              HasSubstr("Found after 1.0 s, and tracked in 30 of 40 frames."));
  EXPECT_EQ(page["facts"][1][1], "75.0\u00A0% of the frames");
  const Json rows = part_of(page, "Errors while tracked")["rows"];
  EXPECT_EQ(rows[0]["cells"], Json::parse(R"json(["position (m)",2,2,2,2,0])json"));
  EXPECT_EQ(rows[1]["cells"][1], 3);
  EXPECT_EQ(part_of(page, "The belief over time")["parts"].size(), 6U);
}

TEST(FindReportData, AVehicleThatIsNeverFoundIsToldOf) {
  const Json page = find_report_data(FoundRun(5, 5).input());
  EXPECT_EQ(page["lead"], "The vehicle was not found in 5 frames.");
  EXPECT_EQ(page["facts"][0][1], "never");
  EXPECT_THAT(layers_of(part_of(page, "Position error over time"), "texts"), ::testing::IsEmpty());
}

TEST(FindReportData, FramesInAWrongPlaceAreToldOf) {
  FoundRun run(40, 10);
  const auto lead = [&] { return find_report_data(run.input())["lead"].get<std::string>(); };
  EXPECT_THAT(lead(), Not(HasSubstr("the position was wrong")));
  for (std::size_t i : {5U, 20U, 21U}) {
    const LocalFrame here(run.drive.frames[i].position);
    run.found[i].fix.position = here.geo_from_enu({50, 0, 0});
  }
  EXPECT_THAT(lead(), HasSubstr("In 2 frames the position was wrong by more than 10 m."));
}

TEST(FindReportData, IsTheSameEachTime) {
  EXPECT_EQ(report_page(find_report_data(FoundRun(30, 10).input())),
            report_page(find_report_data(FoundRun(30, 10).input())));
}

TEST(FindReportData, WithoutRecordedPositionsNoErrorIsToldOrDrawn) {
  FoundRun run(20, 5);
  for (Frame& frame : run.drive.frames) frame.position.latitude_deg = kNaN;
  const Json page = find_report_data(run.input());
  EXPECT_THAT(part_of(page, "Position error over time")["plots"], ::testing::IsEmpty());
  EXPECT_TRUE(page["columns"]["error_m"][7].is_null());
  EXPECT_TRUE(page["columns"]["east_m"][7].is_null());
  EXPECT_THAT(page["lead"].get<std::string>(), HasSubstr("tracked in 15 of 20 frames."));
}

TEST(FindReportData, EveryFrameHasItsValues) {
  FoundRun run(40, 10);
  run.found[20].fix.inlier_ratio = 0.75;
  const Json page = find_report_data(run.input());
  const Json& columns = page["columns"];
  EXPECT_EQ(columns["frame"][20], "frame20.jpg");
  EXPECT_EQ(columns["time_s"][20], 2);
  EXPECT_NEAR(columns["error_m"][20].get<double>(), 2, 1e-3);
  EXPECT_EQ(columns["sigma_m"][20], 0.9);
  EXPECT_NEAR(columns["heading_error_deg"][20].get<double>(), 3, 1e-2);
  EXPECT_EQ(columns["mode_probability"][20], 0.5);
  EXPECT_EQ(columns["inlier_ratio"][20], 0.75);
  const Json words = page["frames"]["rows"][0]["values"][0]["words"];
  EXPECT_EQ(words[columns["status"][9].get<std::size_t>()], "initializing");
  EXPECT_EQ(words[columns["status"][10].get<std::size_t>()], "tracking");
}

TEST(FindReportData, ABackdropIsHeldOnceInMetresEastAndNorth) {
  const FoundRun run(20, 5);
  FindReportInput input = run.input();
  EXPECT_FALSE(find_report_data(input).contains("ground"));
  // The walls' box, 223 m from south to north about its origin.
  input.backdrop = Backdrop{cv::Mat(200, 200, CV_8UC3, cv::Scalar(90, 90, 90)),
                            {1e-5, 0, 0, -1e-5, 8.399005, 49.000995}};
  const Json picture = find_report_data(input)["ground"]["picture"];
  EXPECT_THAT(picture["href"].get<std::string>(), HasSubstr("data:image/jpeg;base64,/9j/"));
  const auto metres = picture["east_north_m"].get<std::vector<double>>();
  ASSERT_EQ(metres.size(), 6U);
  EXPECT_NEAR(metres[0], 146.3, 0.2);   // to the right
  EXPECT_NEAR(metres[3], -222.4, 0.2);  // downwards
  EXPECT_NEAR(metres[4], -metres[0] / 2, 0.1);
  EXPECT_NEAR(metres[5], -metres[3] / 2, 0.1);
}

TEST(FindReportData, OfABackdropOnlyWhatPlansShowIsInThePage) {
  const FoundRun run(20, 5);
  FindReportInput input = run.input();
  // An image of 20 by 20 km around the walls, and one next to them.
  const cv::Mat town(2000, 2000, CV_8UC3, cv::Scalar(90, 90, 90));
  input.backdrop = Backdrop{town, {1e-4, 0, 0, -1e-4, 8.3, 49.1}};
  EXPECT_TRUE(find_report_data(input).contains("ground"));
  EXPECT_LT(find_report_data(input).dump().size(), 200'000U);
  input.backdrop = Backdrop{town, {1e-4, 0, 0, -1e-4, 8.6, 49.1}};
  EXPECT_FALSE(find_report_data(input).contains("ground"));
}

TEST(FindReportData, ALongDriveStaysSmall) {
  EXPECT_LT(report_page(find_report_data(FoundRun(3000, 100).input())).size(), 1'500'000U);
}

TEST(SnapshotFigures, TellTheMoment) {
  const FoundRun run(40, 10);
  const Drawn drawn(run);
  const std::vector<Figure> figures = snapshot_figures(drawn.series);
  ASSERT_EQ(figures.size(), 6U);
  EXPECT_THAT(figures[0].heading, HasSubstr("1\u20020.0 s: start"));
  EXPECT_THAT(figures[1].heading, HasSubstr("initializing"));
  EXPECT_THAT(figures[2].heading, HasSubstr("3\u20021.0 s: found"));
  EXPECT_THAT(figures[3].heading, HasSubstr("tracking"));
  EXPECT_THAT(figures[5].heading, HasSubstr("3.9 s: end"));
  EXPECT_THAT(figures[2].caption, HasSubstr("status tracking"));
  EXPECT_THAT(figures[2].caption, HasSubstr("50\u00A0% of the belief"));
  EXPECT_THAT(figures[2].caption, HasSubstr("Off by 2.00\u00A0m"));
}

TEST(SnapshotFigures, ShowEveryParticleOfAnAreaWithItsHeading) {
  const FoundRun run(40, 10);
  Drawn drawn(run);
  drawn.series.snapshots[0].particles[0].heading_rad = std::numbers::pi / 2;
  drawn.series.snapshots[0].particles[1].heading_rad = 0;
  const std::vector<Json> dots = layers_of(drawn.snapshot(0), "dots", "particle with its heading");
  ASSERT_EQ(dots.size(), 2U);
  EXPECT_EQ(dots[0]["marker"], "dash");
  EXPECT_EQ(dots[0]["x"].size(), 200U);
  EXPECT_EQ(dots[0]["rotation_deg"][0], 0);    // to the east, like the unrotated dash
  EXPECT_EQ(dots[0]["rotation_deg"][1], -90);  // to the north
  EXPECT_EQ(dots[1]["x"], dots[0]["x"]);
}

TEST(SnapshotFigures, ShowACloseUpOfAGatheredBeliefOnly) {
  const FoundRun run(40, 10);
  Drawn drawn(run);
  EXPECT_THAT(snapshot_figures(drawn.series)[2].caption, HasSubstr("The whole area"));
  const PlanPoint at = drawn.series.found[drawn.series.snapshots[2].frame];
  std::vector<Pose2>& particles = drawn.series.snapshots[2].particles;
  for (std::size_t k = 0; k < 195; ++k) particles[k].enu_m = {at.x, at.y};
  for (std::size_t k = 195; k < 200; ++k) particles[k].enu_m = {at.x + 50, at.y};
  EXPECT_THAT(snapshot_figures(drawn.series)[2].caption, HasSubstr("Close-up"));
  EXPECT_EQ(layers_of(drawn.snapshot(2), "dots").at(0)["x"].size(), 195U);
}

TEST(SnapshotFigures, ACircleOfTwoSigmasIsDrawnWhileTracked) {
  const FoundRun run(40, 10);
  const Drawn drawn(run);
  const auto circles = [&](std::size_t number) {
    std::vector<Json> lines = layers_of(drawn.snapshot(number), "line");
    std::erase_if(lines, [](const Json& line) { return !line.contains("radius_m"); });
    return lines;
  };
  EXPECT_EQ(circles(0).size(), 0U);
  ASSERT_EQ(circles(2).size(), 1U);
  EXPECT_EQ(circles(2)[0]["radius_m"], 1.8);
  const PlanPoint at = drawn.series.found[drawn.series.snapshots[2].frame];
  EXPECT_NEAR(circles(2)[0]["at"][0].get<double>(), at.x, 1e-3);
}

TEST(SnapshotFigures, PathsGoAsFarAsTheVehicle) {
  const FoundRun run(40, 10);
  const Drawn drawn(run);
  const auto length = [&](std::size_t number, const char* name) {
    const Json x = layers_of(drawn.snapshot(number), "line", name).at(0)["x"];
    return std::count_if(x.begin(), x.end(), [](const Json& each) { return !each.is_null(); });
  };
  EXPECT_EQ(length(0, "recorded path so far"), 1);
  EXPECT_EQ(length(2, "recorded path so far"), 11);
  EXPECT_EQ(length(5, "recorded path so far"), 40);
  EXPECT_EQ(length(5, "tracked path so far"), 30);  // frames 10 to 39
}

TEST(PathFigure, HasADotPerFrameByStatusAndTheSnapshotsNumbers) {
  FoundRun run(40, 10);
  run.found[20].fix.status = GlobalStatus::predicted;
  run.found[21].fix.status = GlobalStatus::lost;
  const Drawn drawn(run);
  const Json figure = json_of(path_figure(drawn.series));
  const auto count = [&](const char* name) {
    return layers_of(figure, "dots", name).at(0)["x"].size();
  };
  EXPECT_EQ(count("initializing"), 10U);
  EXPECT_EQ(count("tracking"), 28U);
  EXPECT_EQ(count("predicted"), 1U);
  EXPECT_EQ(count("lost"), 1U);
  EXPECT_EQ(layers_of(figure, "texts").at(0)["text"], Json::parse(R"(["1","2","3","4","5","6"])"));
}

TEST(PathFigure, OfManyFramesSomeHaveADot) {
  const FoundRun run(2000, 0);
  const Drawn drawn(run);
  const Json figure = json_of(path_figure(drawn.series));
  EXPECT_THAT(figure["caption"].get<std::string>(), HasSubstr("one of 4 frames"));
  EXPECT_EQ(layers_of(figure, "dots", "tracking").at(0)["x"].size(), 500U);
}

TEST(ErrorFigures, HoldTheErrorOverWhatIsClaimedAndTheStatus) {
  const FoundRun run(40, 10);
  const Json figure = Drawn(run).position_error();
  EXPECT_NEAR(layers_of(figure, "line", "error").at(0)["y"][3].get<double>(), 2, 1e-3);
  EXPECT_EQ(layers_of(figure, "area").at(0)["y"][3], 1.8);
  EXPECT_EQ(figure["plots"][0]["y"]["min"], 1);
  EXPECT_EQ(figure["plots"][0]["y"]["max"], 10);
  EXPECT_EQ(figure["plots"][0]["lanes"],
            Json::parse(R"([{"marks":[[0,1,"initializing"],[1,3.9,"tracking"]]}])"));
  EXPECT_EQ(layers_of(figure, "texts").at(0)["text"][0], "found");
}

TEST(ErrorFigures, AnErrorBelowTheAxisLiesOnItsEdge) {
  FoundRun run(3, 0);
  for (std::size_t i = 0; i < 3; ++i) run.found[i].fix.position = run.drive.frames[i].position;
  const Json figure = Drawn(run).position_error();
  EXPECT_EQ(layers_of(figure, "line", "error").at(0)["y"][0], 0.1);
  EXPECT_EQ(figure["plots"][0]["y"]["min"], 0.1);
}

TEST(Ground, HasEveryWallInMetresEastAndNorth) {
  const FoundRun run(3, 0);
  const Json page = find_report_data(run.input());
  const Json east_m = page["columns"]["wall_east_m"];
  const Json north_m = page["columns"]["wall_north_m"];
  ASSERT_EQ(east_m.size(), 12U);  // two corners and a gap each
  EXPECT_TRUE(east_m[2].is_null());
  // The west one, from south to north.
  EXPECT_NEAR(east_m[0].get<double>(), -73.2, 0.1);
  EXPECT_NEAR(north_m[0].get<double>(), -111.2, 0.1);
  EXPECT_NEAR(east_m[1].get<double>(), -73.2, 0.1);
  EXPECT_NEAR(north_m[1].get<double>(), 111.2, 0.1);
}

}  // namespace
}  // namespace milepost
