#include "mapper/report/map_report_data.h"

#include <gmock/gmock.h>

#include "tests/mapper/report/made_up_map.h"

namespace milepost {
namespace {

using testing::made_up_report;
using testing::MadeUpSegment;

StretchFit fit_of(double from_m, const std::string& drive, std::uint64_t followed,
                  std::uint64_t fitting) {
  StretchFit made;
  made.from_m = from_m;
  made.to_m = from_m + 10;
  made.drive = drive;
  made.fit.followed = followed;
  made.fit.fitting = fitting;
  return made;
}

TEST(MapReportData, ASegmentIsStretchesOfTenMetres) {
  const MapReportData data = made_up_report({{}});
  ASSERT_EQ(data.segments.size(), 1U);
  const std::vector<MapStretch>& stretches = data.segments[0].stretches;
  ASSERT_EQ(stretches.size(), 6U);
  for (std::size_t k = 0; k < 5; ++k) {
    EXPECT_DOUBLE_EQ(stretches[k].along.from_m, 10.0 * static_cast<double>(k));
    EXPECT_EQ(stretches[k].landmarks, 40U);
    EXPECT_FALSE(stretches[k].has_gap);
  }
  EXPECT_NEAR(stretches[5].along.to_m, 57, 0.01);
  EXPECT_EQ(stretches[5].landmarks, 28U);
  EXPECT_NEAR(stretches[3].in_sight, 48, 2);  // 4 a metre, over 12 m
  EXPECT_EQ(data.landmark_count(), 228U);
  EXPECT_NEAR(data.length_m(), 57, 0.01);
}

TEST(MapReportData, AShortRestBelongsToTheStretchBeforeIt) {
  MadeUpSegment segment;
  segment.length_m = 23;
  segment.mapped = {{0, 23}};
  const MapReportData data = made_up_report({segment});
  ASSERT_EQ(data.segments[0].stretches.size(), 2U);
  EXPECT_NEAR(data.segments[0].stretches[1].along.to_m, 23, 0.01);
  EXPECT_EQ(data.segments[0].stretches[1].landmarks, 52U);
  segment.length_m = 3;
  segment.mapped = {{0, 3}};
  EXPECT_EQ(made_up_report({segment}).segments[0].stretches.size(), 1U);
}

TEST(MapReportData, SigmaInTheWorldHasTheMapsOwnError) {
  MadeUpSegment known;
  known.position_error = {0.05, 200.0, false};
  MadeUpSegment unknown;
  unknown.id = "tuesday-0";
  unknown.east_m = 30;
  unknown.position_error = {};
  const MapReportData data = made_up_report({known, unknown});
  const MapStretch& stretch = data.segments[0].stretches[2];
  ASSERT_TRUE(stretch.sigma_map && stretch.sigma_world_m);
  EXPECT_DOUBLE_EQ(*stretch.sigma_world_m, std::hypot(stretch.sigma_map->worse_m(), 0.05));
  EXPECT_LT(stretch.sigma_map->worse_m(), 0.1);
  EXPECT_TRUE(data.segments[1].stretches[2].sigma_map);
  EXPECT_FALSE(data.segments[1].stretches[2].sigma_world_m);
}

TEST(MapReportData, WhereNothingIsMappedIsAGapWithoutSigma) {
  MadeUpSegment segment;
  segment.mapped = {{0, 20}};
  const std::vector<MapStretch> stretches = made_up_report({segment}).segments[0].stretches;
  EXPECT_FALSE(stretches[0].has_gap);
  EXPECT_TRUE(stretches[0].sigma_map);
  EXPECT_TRUE(stretches[4].has_gap);
  EXPECT_EQ(stretches[4].in_sight, 0);
  EXPECT_FALSE(stretches[4].sigma_map);
  EXPECT_FALSE(stretches[4].sigma_world_m);
}

TEST(MapReportData, LandmarksOfTwoDrivesKnowMore) {
  MadeUpSegment segment;
  segment.passes = {{"monday", 0, 57}, {"tuesday", 5, 62}};
  const MapReportData once = made_up_report({segment});
  segment.landmark_passes = 2;
  const MapReportData twice = made_up_report({segment});
  EXPECT_EQ(once.segments[0].stretches[2].repeated, 0);
  EXPECT_EQ(twice.segments[0].stretches[2].repeated, twice.segments[0].stretches[2].in_sight);
  EXPECT_LT(twice.segments[0].stretches[2].sigma_map->worse_m(),
            once.segments[0].stretches[2].sigma_map->worse_m());
}

TEST(MapReportData, FiguresOfLandmarks) {
  const LandmarkFigures figures = made_up_report({{}}).landmarks;
  ASSERT_EQ(figures.distance_m.size(), 228U);
  EXPECT_NEAR(figures.track_m[0], 12, 0.1);
  // The first is seen over 12 m, mapped from the middle of them: 6 + 15 m ahead and 5 m beside.
  EXPECT_NEAR(figures.distance_m[0], std::hypot(21, 5), 0.1);
  EXPECT_EQ(figures.drives[0], 1);
}

TEST(MapReportData, TilesTellTheirSize) {
  const MapReportData data = made_up_report({{}});
  ASSERT_EQ(data.tile_kb_per_m.size(), 3U);  // of 20, 20 and 17 m
  double bytes = 0;
  for (std::size_t i = 0; i < 3; ++i) bytes += 1000 * data.tile_kb_per_m[i] * (i == 2 ? 17 : 20);
  EXPECT_NEAR(bytes, static_cast<double>(data.segments[0].inspected.bytes), 5);
}

TEST(MapReportData, WhatWasRecordedIsWithItsStretchAndDrive) {
  MappingRecord record;
  record.segments["monday-0"] = {fit_of(20, "monday", 100, 90), fit_of(50, "monday", 50, 10)};
  record.segments["elsewhere"] = {fit_of(20, "monday", 1, 1)};
  record.drives = {{"monday", {80, 5000, 4500, 0.7, 0.03, 0.02, 0.1}}};
  record.findings = {{"noise", "monday", "trajectory.csv", "positions are noisy", "", 3, 7}};
  const MapReportData data = made_up_report({{}}, record);
  const std::vector<MapStretch>& stretches = data.segments[0].stretches;
  EXPECT_TRUE(stretches[1].fits.empty());
  ASSERT_EQ(stretches[2].fits.size(), 1U);
  EXPECT_EQ(stretches[2].fits[0].fit.fitting, 90U);
  EXPECT_EQ(stretches[5].fits.size(), 1U);
  ASSERT_EQ(data.drives.size(), 1U);
  EXPECT_EQ(data.drives[0].passes, 1U);
  EXPECT_EQ(data.drives[0].fit->followed, 5000U);
  ASSERT_TRUE(data.findings);
  EXPECT_EQ(data.findings->size(), 1U);
  EXPECT_FALSE(made_up_report({{}}).findings);
}

TEST(MapReportData, AMapWithoutSegmentsIsOne) {
  const MapReportData data = made_up_report({});
  EXPECT_TRUE(data.segments.empty());
  EXPECT_EQ(data.length_m(), 0);
}

}  // namespace
}  // namespace milepost
