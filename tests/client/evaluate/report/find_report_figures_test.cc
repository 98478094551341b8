// What the figures of a found drive's report draw.
#include "client/evaluate/report/find_report_figures.h"

#include <gmock/gmock.h>

#include <regex>

#include "tests/client/evaluate/found_run.h"

namespace milepost {
namespace {

using testing::FoundRun;
using ::testing::HasSubstr;

std::size_t count_of(const std::string& text, const std::string& pattern) {
  const std::regex expression(pattern);
  return static_cast<std::size_t>(
      std::distance(std::sregex_iterator(text.begin(), text.end(), expression), {}));
}

// The data of the paths of a class, one after another.
std::vector<std::string> paths_of(const std::string& drawing, const std::string& css_class) {
  std::vector<std::string> paths;
  const std::regex expression("<path class=\"" + css_class + "\" d=\"([^\"]*)\"");
  for (std::sregex_iterator at(drawing.begin(), drawing.end(), expression), end; at != end; ++at) {
    paths.push_back((*at)[1]);
  }
  return paths;
}

std::size_t corners_of(const std::string& path) { return count_of(path, R"(-?\d+ -?\d+)"); }

// The figures of a run; what the test changes in it must be changed before.
struct Drawn {
  explicit Drawn(const FoundRun& run) : input(run.input()), series(found_series(input)) {}
  Drawn(const Drawn&) = delete;
  Drawn& operator=(const Drawn&) = delete;

  std::string position_error() const { return position_error_figure(series).drawing; }
  std::string heading_error() const { return heading_error_figure(series).drawing; }
  std::string belief() const { return belief_figure(series).drawing; }

  FindReportInput input;
  FoundSeries series;
};

TEST(SnapshotFigures, AreOnePerSnapshotAndTellTheMoment) {
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
  const std::string drawing = snapshot_figures(Drawn(run).series)[0].drawing;
  const std::vector<std::string> particles = paths_of(drawing, "particle");
  ASSERT_EQ(particles.size(), 1U);
  EXPECT_EQ(count_of(particles[0], "h1"), 200U);
  EXPECT_EQ(count_of(paths_of(drawing, "particle tick").at(0), "M"), 200U);
}

TEST(SnapshotFigures, ShowACloseUpOfAGatheredBeliefOnly) {
  const FoundRun run(40, 10);
  Drawn drawn(run);
  EXPECT_THAT(snapshot_figures(drawn.series)[2].caption, HasSubstr("The whole area"));
  const plot::Point& at = drawn.series.found[drawn.series.snapshots[2].frame];
  std::vector<PlanPose>& particles = drawn.series.snapshots[2].particles;
  for (std::size_t k = 0; k < 195; ++k) particles[k].enu_m = {at.x, at.y};
  for (std::size_t k = 195; k < 200; ++k) particles[k].enu_m = {at.x + 50, at.y};
  const Figure figure = snapshot_figures(drawn.series)[2];
  EXPECT_THAT(figure.caption, HasSubstr("Close-up"));
  EXPECT_EQ(count_of(paths_of(figure.drawing, "particle").at(0), "h1"), 195U);
}

TEST(SnapshotFigures, ACircleOfTwoSigmasIsDrawnWhileTracked) {
  const FoundRun run(40, 10);
  const std::vector<Figure> figures = snapshot_figures(Drawn(run).series);
  const auto circles = [](const std::string& drawing) {
    std::size_t count = 0;
    for (const std::string& path : paths_of(drawing, "m0 line chief")) {
      if (corners_of(path) == 73) ++count;
    }
    return count;
  };
  EXPECT_EQ(circles(figures[0].drawing), 0U);
  EXPECT_EQ(circles(figures[1].drawing), 0U);
  EXPECT_EQ(circles(figures[2].drawing), 1U);
  // Its first corner lies two sigmas east of the densest place.
  std::smatch circle;
  const std::string path = paths_of(figures[2].drawing, "m0 line chief").back();
  ASSERT_TRUE(std::regex_search(path, circle, std::regex(R"(^M(\d+) \d+L)")));
  std::smatch dot;
  ASSERT_TRUE(std::regex_search(figures[2].drawing, dot,
                                std::regex("class=\"f-tracking\" r=\"3.0\" cx=\"([0-9.]+)%")));
  std::smatch metre;
  ASSERT_TRUE(std::regex_search(figures[2].drawing, metre,
                                std::regex(R"(#ground" transform="matrix\(([0-9.]+))")));
  EXPECT_NEAR(std::stod(circle[1]) - 100 * std::stod(dot[1]), 1.8 * std::stod(metre[1]), 2);
}

TEST(SnapshotFigures, PathsGoAsFarAsTheVehicle) {
  const FoundRun run(40, 10);
  const Drawn drawn(run);
  const std::vector<Figure> figures = snapshot_figures(drawn.series);
  EXPECT_EQ(corners_of(paths_of(figures[0].drawing, "recorded").at(0)), 1U);
  EXPECT_EQ(corners_of(paths_of(figures[2].drawing, "recorded").at(0)), 11U);
  EXPECT_EQ(corners_of(paths_of(figures[5].drawing, "recorded").at(0)), 40U);
  // Of frames 10 to 39, which are tracked.
  EXPECT_EQ(corners_of(paths_of(figures[5].drawing, "m0 line chief").at(0)), 30U);
  for (const Figure& figure : figures) {
    EXPECT_EQ(count_of(figure.drawing, "class=\"here\""), 1U);
    EXPECT_EQ(count_of(figure.drawing, "href=\"#north\""), 2U);
    EXPECT_EQ(count_of(figure.drawing, "class=\"scale\""), 1U);
  }
}

TEST(PathFigure, HasADotPerFrameByStatusAndTheSnapshotsNumbers) {
  FoundRun run(40, 10);
  run.found[20].fix.status = FindStatus::predicted;
  run.found[21].fix.status = FindStatus::lost;
  const std::string drawing = path_figure(Drawn(run).series).drawing;
  EXPECT_EQ(count_of(drawing, "<circle class=\"nofix\""), 10U);
  EXPECT_EQ(count_of(drawing, "<circle class=\"f-tracking\""), 28U);
  EXPECT_EQ(count_of(drawing, "<circle class=\"f-predicted\""), 1U);
  EXPECT_EQ(count_of(drawing, "<circle class=\"f-lost\""), 1U);
  EXPECT_THAT(drawing, HasSubstr("frame20.jpg, 2.0 s: predicted, off by 2.00\u00A0m"));
  for (int k = 1; k <= 6; ++k) EXPECT_THAT(drawing, HasSubstr(">" + std::to_string(k) + "</text>"));
}

TEST(PathFigure, OfManyFramesSomeHaveADot) {
  const FoundRun run(2000, 0);
  const Figure figure = path_figure(Drawn(run).series);
  EXPECT_THAT(figure.caption, HasSubstr("one of 4 frames"));
  EXPECT_EQ(count_of(figure.drawing, "<circle class=\"f-tracking\""), 500U);
}

TEST(ErrorFigures, DrawTheErrorOverWhatIsClaimed) {
  FoundRun run(40, 10);
  for (FoundFrame& frame : run.found) frame.fix.heading_deg = 357;
  const Drawn drawn(run);
  const std::string position = drawn.position_error();
  // 2 m and 1.8 m on an axis from 1 to 10, of 10000 from above.
  EXPECT_THAT(paths_of(position, "m0 line chief").at(0), HasSubstr("M0 6990L"));
  EXPECT_THAT(paths_of(position, "band").at(0), HasSubstr(" 7447 "));
  const std::string heading = drawn.heading_error();  // 3 and 4 degrees
  EXPECT_THAT(paths_of(heading, "m0 line chief").at(0), HasSubstr("M0 5229L"));
  EXPECT_THAT(paths_of(heading, "band").at(0), HasSubstr(" 3979 "));
}

TEST(ErrorFigures, AnErrorBelowTheAxisLiesOnItsEdge) {
  FoundRun run(3, 0);
  for (std::size_t i = 0; i < 3; ++i) run.found[i].fix.position = run.drive.frames[i].position;
  const std::string drawing = Drawn(run).position_error();
  EXPECT_THAT(paths_of(drawing, "m0 line chief").at(0), HasSubstr("M0 10000L"));
  EXPECT_THAT(drawing, HasSubstr(">0.1</text>"));
}

TEST(ErrorFigures, TheLaneShowsTheStatusAndALineWhenItWasFound) {
  FoundRun run(40, 10);
  const std::string drawing = Drawn(run).position_error();
  EXPECT_EQ(count_of(drawing, "class=\"s-"), 2U);
  EXPECT_THAT(drawing, HasSubstr("<title>initializing, 10 frames</title>"));
  EXPECT_THAT(drawing, HasSubstr("<title>tracking, 30 frames</title>"));
  EXPECT_EQ(count_of(drawing, "class=\"moment\""), 1U);
  EXPECT_THAT(drawing, HasSubstr(">found</text>"));
  const FoundRun never(5, 5);
  EXPECT_EQ(count_of(Drawn(never).position_error(), "class=\"moment\""), 0U);
}

TEST(ErrorFigures, TheNumbersOfAFrameAreShownWhileThePointerRestsThere) {
  FoundRun run(40, 10);
  run.found[20].fix.explained = 0.75;
  EXPECT_THAT(Drawn(run).position_error(),
              HasSubstr("frame20.jpg, 2.0 s: tracking\nposition off by 2.00 m (\u03C3 0.90 m)\n"
                        "heading off by +3.0\u00B0 (\u03C3 2.0\u00B0)\nmass 0.50, explained 0.75"));
  const FoundRun many(2000, 0);
  EXPECT_LE(count_of(Drawn(many).position_error(), "<rect"), 501U);
}

TEST(BeliefFigure, DrawsMassAndExplainedShare) {
  FoundRun run(40, 10);
  for (FoundFrame& frame : run.found) frame.fix.explained = 0.25;
  const std::string drawing = Drawn(run).belief();
  EXPECT_THAT(paths_of(drawing, "m0 line chief").at(0), HasSubstr("M0 5000L"));
  EXPECT_THAT(paths_of(drawing, "m1 line").at(0), HasSubstr("M0 7500L"));
}

TEST(PlanGround, HasEveryWallInMetresSouthAndEast) {
  const FoundRun run(3, 0);
  const std::string ground = plan_ground(Drawn(run).series);
  const std::string walls = paths_of(ground, "wall").at(0);
  EXPECT_EQ(count_of(walls, "M"), 4U);
  // The west one, from south to north.
  std::smatch west;
  ASSERT_TRUE(std::regex_search(
      walls, west, std::regex(R"(^M(-?[0-9.]+) (-?[0-9.]+)L(-?[0-9.]+) (-?[0-9.]+)M)")));
  EXPECT_NEAR(std::stod(west[1]), -73.2, 0.1);
  EXPECT_NEAR(std::stod(west[2]), 111.2, 0.1);
  EXPECT_NEAR(std::stod(west[3]), -73.2, 0.1);
  EXPECT_NEAR(std::stod(west[4]), -111.2, 0.1);
}

}  // namespace
}  // namespace milepost
