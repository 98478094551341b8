// The area of each plan in a global localization report.
#include "client/evaluate/report/find_plan_areas.h"

#include <gmock/gmock.h>

#include <cmath>

#include "tests/client/evaluate/found_run.h"

namespace milepost {
namespace {

using testing::FoundRun;

double height_share(const PlanArea& area) { return area.north.length() / area.east.length(); }

// Areas of a run that never converges, with given particles in a snapshot.
class CloseUp : public ::testing::Test {
 protected:
  std::optional<PlanArea> with_particles_at(const PlanPoint& place) const {
    return with_particles_at(place, 0, place);
  }

  // `others` of 100 particles lie elsewhere.
  std::optional<PlanArea> with_particles_at(const PlanPoint& place, std::size_t others,
                                            const PlanPoint& elsewhere) const {
    FindSnapshot snapshot{kFrame, {}};
    for (std::size_t k = 0; k < 100; ++k) {
      const PlanPoint& at = k < others ? elsewhere : place;
      snapshot.particles.push_back({{at.x, at.y}, 0});
    }
    return close_up_area(series_, snapshot);
  }

  PlanPoint found() const { return series_.found[kFrame]; }

  static constexpr std::size_t kFrame = 12;
  FoundRun run_{20, 20};
  FindReportInput input_ = run_.input();
  FoundSeries series_ = found_series(input_);
};

TEST(PlanAreas, TheWholeOneHoldsWallsAndPathInOneShape) {
  const FoundRun run(20, 5);
  const FindReportInput input = run.input();
  const FoundSeries series = found_series(input);
  const PlanArea area = whole_area(series);
  for (const PlanWall& wall : run.recorder.walls()) {
    EXPECT_TRUE(area.contains({wall.begin_m.x(), wall.begin_m.y()}));
    EXPECT_TRUE(area.contains({wall.end_m.x(), wall.end_m.y()}));
  }
  for (const PlanPoint& point : series.recorded) EXPECT_TRUE(area.contains(point));
  EXPECT_NEAR(height_share(area), 0.8, 1e-9);
}

TEST(PlanAreas, TheWholeOneHoldsAPathBeyondTheWalls) {
  FoundRun run(20, 5);
  run.drive.frames[3].position = LocalFrame(run.recorder.origin()).geo_from_enu({400, 0, 0});
  const FindReportInput input = run.input();
  const FoundSeries series = found_series(input);
  EXPECT_TRUE(whole_area(series).contains(series.recorded[3]));
  EXPECT_TRUE(path_area(series).contains(series.recorded[3]));
}

TEST(PlanAreas, WhereNoPathIsKnownItsAreaIsTheWhole) {
  FoundRun run(5, 5);
  for (Frame& frame : run.drive.frames) frame.position.latitude_deg = std::nan("");
  const FindReportInput input = run.input();
  const FoundSeries series = found_series(input);
  EXPECT_EQ(path_area(series).east.from, whole_area(series).east.from);
  EXPECT_EQ(path_area(series).north.to, whole_area(series).north.to);
}

TEST(PlanAreas, ThePathsOneIsLessThanTheWholeAndHoldsWhatWasTracked) {
  FoundRun run(20, 5);
  const LocalFrame frame(run.recorder.origin());
  run.found[2].fix.position = frame.geo_from_enu({5000, 0, 0});  // before it was found
  run.found[8].fix.position = frame.geo_from_enu({-100, 30, 0});
  const FindReportInput input = run.input();
  const FoundSeries series = found_series(input);
  const PlanArea area = path_area(series);
  EXPECT_TRUE(area.contains(series.found[8]));
  EXPECT_FALSE(area.contains(series.found[2]));
  EXPECT_LT(area.east.length(), whole_area(series).east.length());
}

TEST_F(CloseUp, IsAboutTheDensestPlace) {
  const std::optional<PlanArea> area = with_particles_at(found());
  ASSERT_TRUE(area);
  EXPECT_NEAR((area->east.from + area->east.to) / 2, found().x, 1e-9);
  EXPECT_NEAR((area->north.from + area->north.to) / 2, found().y, 1e-9);
  EXPECT_NEAR(height_share(*area), 0.8, 1e-9);
  EXPECT_LT(area->east.length(), 50);
}

TEST_F(CloseUp, LeavesOutATenthOfTheParticlesAtMost) {
  const PlanPoint far = {found().x + 60, found().y};
  EXPECT_TRUE(with_particles_at(found(), 10, far));
  EXPECT_FALSE(with_particles_at(found(), 11, far));
}

TEST_F(CloseUp, NeverHidesThatTheVehicleWasElsewhere) {
  series_.recorded[kFrame].x += 30;
  EXPECT_FALSE(with_particles_at(found()));
  series_.recorded[kFrame].x = std::nan("");
  EXPECT_TRUE(with_particles_at(found()));
}

TEST(PlanAreas, TheShownBoundsHoldEveryPlan) {
  FoundRun run(20, 0);
  run.found[8].fix.position = LocalFrame(run.recorder.origin()).geo_from_enu({-300, 0, 0});
  const FindReportInput input = run.input();
  const FoundSeries series = found_series(input);
  const Bounds shown = shown_bounds(series);
  const LocalFrame frame(run.recorder.origin());
  for (const PlanArea& area : {whole_area(series), path_area(series)}) {
    const GeoPoint south_west = frame.geo_from_enu({area.east.from, area.north.from, 0});
    const GeoPoint north_east = frame.geo_from_enu({area.east.to, area.north.to, 0});
    EXPECT_LT(shown.west_deg, south_west.longitude_deg);
    EXPECT_LT(shown.south_deg, south_west.latitude_deg);
    EXPECT_GT(shown.east_deg, north_east.longitude_deg);
    EXPECT_GT(shown.north_deg, north_east.latitude_deg);
  }
  EXPECT_LT(shown.north_deg - shown.south_deg, 0.01);
}

}  // namespace
}  // namespace milepost
