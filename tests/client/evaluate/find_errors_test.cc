// The errors of global localization.
#include "client/evaluate/find_errors.h"

#include <gmock/gmock.h>

#include <cmath>

#include "tests/client/evaluate/found_run.h"

namespace milepost {
namespace {

using testing::FoundRun;

FindSummary summary_of(const FoundRun& run) {
  return find_summary(run.found, find_errors(run.drive, run.found));
}

// Ten frames with given errors of their fixes in metres north.
FoundRun steps_of_a_metre() {
  FoundRun run(10, 0);
  for (std::size_t i = 0; i < 10; ++i) {
    const LocalFrame here(run.drive.frames[i].position);
    run.found[i].fix.position = here.geo_from_enu({0, static_cast<double>(i + 1), 0});
    run.found[i].fix.sigma_m = 2.1;
  }
  return run;
}

TEST(FindErrors, HeadingsAreComparedAcrossNorth) {
  FoundRun run(3, 0);  // the fixes have a heading of 3 degrees
  run.drive.frames[1].heading_deg = 359;
  run.drive.frames[2].heading_deg = 7;
  const std::vector<FindError> errors = find_errors(run.drive, run.found);
  EXPECT_NEAR(errors[0].heading_deg, 3, 1e-9);
  EXPECT_NEAR(errors[1].heading_deg, 4, 1e-9);
  EXPECT_NEAR(errors[2].heading_deg, -4, 1e-9);
}

TEST(FindErrors, OfAnUnknownPositionNoneIsKnown) {
  FoundRun run(3, 0);
  run.drive.frames[1].position.latitude_deg = std::nan("");
  const std::vector<FindError> errors = find_errors(run.drive, run.found);
  EXPECT_TRUE(std::isnan(errors[1].position_m));
  EXPECT_TRUE(std::isnan(errors[1].heading_deg));
  const FindSummary summary = find_summary(run.found, errors);
  EXPECT_EQ(summary.tracked_frames, 3U);
  EXPECT_NEAR(summary.position_m.max, 2, 0.001);
}

TEST(FindSummary, CountsFromTheFirstTrackedFrame) {
  FoundRun run(40, 10);
  for (FoundFrame& frame : run.found) frame.fix.timestamp_s += 1000;
  run.found[30].fix.status = GlobalStatus::predicted;
  run.found[31].fix.status = GlobalStatus::lost;
  const FindSummary summary = summary_of(run);
  EXPECT_EQ(summary.frames, 40U);
  EXPECT_EQ(summary.tracked_frames, 29U);
  EXPECT_EQ(summary.found_frame, 10U);
  EXPECT_NEAR(summary.found_after_s, 1, 1e-9);
  EXPECT_EQ(summary.position_m.within_2_sigma, 0);
  EXPECT_EQ(summary.heading_deg.within_2_sigma, 1);
  EXPECT_NEAR(summary.heading_deg.p50, 3, 1e-9);
  EXPECT_NEAR(summary.latency_ms_p50, 29.5, 1e-9);
  EXPECT_NEAR(summary.latency_ms_p99, 48.61, 1e-9);
}

TEST(FindSummary, FiguresAreOfTheTrackedFrames) {
  FoundRun run = steps_of_a_metre();
  const FindErrorFigures all = summary_of(run).position_m;
  EXPECT_NEAR(all.mean, 5.5, 0.001);
  EXPECT_NEAR(all.p50, 5.5, 0.001);
  EXPECT_NEAR(all.p95, 9.55, 0.001);
  EXPECT_NEAR(all.max, 10, 0.001);
  EXPECT_NEAR(all.within_2_sigma, 0.4, 1e-9);
  run.found[9].fix.status = GlobalStatus::lost;
  EXPECT_NEAR(summary_of(run).position_m.max, 9, 0.001);
}

TEST(FindSummary, MoreThanTenMetresOffIsAWrongPlace) {
  FoundRun run = steps_of_a_metre();
  EXPECT_EQ(summary_of(run).wrong_frames, 0U);
  for (std::size_t i : {3U, 4U}) {
    const LocalFrame here(run.drive.frames[i].position);
    run.found[i].fix.position = here.geo_from_enu({11, 0, 0});
  }
  run.found[4].fix.status = GlobalStatus::lost;
  EXPECT_EQ(summary_of(run).wrong_frames, 1U);
}

TEST(FindSummary, WhatIsNeverFoundHasNoFigures) {
  const FindSummary summary = summary_of(FoundRun(5, 5));
  EXPECT_FALSE(summary.found_frame);
  EXPECT_TRUE(std::isnan(summary.position_m.mean));
  EXPECT_TRUE(std::isnan(summary.heading_deg.within_2_sigma));
}

}  // namespace
}  // namespace milepost
