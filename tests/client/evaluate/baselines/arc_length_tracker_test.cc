#include "client/evaluate/baselines/arc_length_tracker.h"

#include <gtest/gtest.h>

#include <cmath>

namespace milepost {
namespace {

TEST(PaperTracker, TakesTheFirstFramesAsMeasured) {  // section 4.2.4
  const auto tracker = make_paper_tracker({});
  tracker->start(0, {100, 0.5, 20});
  EXPECT_TRUE(tracker->advance(0.2, Measurement{102.4, 0.5, 20}));
  EXPECT_DOUBLE_EQ(tracker->pose().along_m, 102.4);
}

TEST(PaperTracker, SearchesFromTheLastPositionToRhoStepsAhead) {  // section 4.2.2
  PaperTrackerSettings settings;
  settings.min_region_m = 0;
  const auto tracker = make_paper_tracker(settings);
  tracker->start(0, {100, 0.5, 20});
  tracker->advance(0.2, Measurement{102, 0.5, 20});
  const AlongRange region = tracker->search_region(0.4);
  EXPECT_DOUBLE_EQ(region.from_m, 102);
  EXPECT_DOUBLE_EQ(region.to_m, 106);
}

TEST(PaperTracker, WithoutFilterItIsTheMeasurement) {
  PaperTrackerSettings settings;
  settings.filter = PaperFilter::none;
  const auto tracker = make_paper_tracker(settings);
  tracker->start(0, {100, 0.5, 20});
  for (int k = 1; k < 6; ++k) {
    const double along_m = 100 + 2 * k + (k % 2 == 0 ? 1 : -1);
    tracker->advance(0.2 * k, Measurement{along_m, 0.5, 20});
    EXPECT_DOUBLE_EQ(tracker->pose().along_m, along_m);
  }
}

TEST(PaperTracker, TrustsTheMotionModelMoreBeyondTheThreshold) {  // section 4.2.3
  PaperTrackerSettings settings;
  settings.first_frames = 1;
  settings.innovation_threshold_m = 1;
  settings.weight_within = 0.1;
  settings.weight_beyond = 10;
  const auto after = [&](double off_m) {
    const auto tracker = make_paper_tracker(settings);
    tracker->start(0, {100, 0.5, 20});
    tracker->advance(0.2, Measurement{100, 0.5, 20});
    tracker->advance(0.4, Measurement{100 + off_m, 0.5, 20});
    return tracker->pose().along_m - 100;
  };
  EXPECT_GT(after(0.9), 0.8);
  EXPECT_LT(after(1.1), 0.5);
}

TEST(PaperTracker, AFrameOfFewTrackletsIsPredictedByTheMotionModel) {  // section 4.2.3
  for (const PaperFilter filter : {PaperFilter::none, PaperFilter::kalman}) {
    PaperTrackerSettings settings;
    settings.filter = filter;
    settings.min_support = 10;
    const auto tracker = make_paper_tracker(settings);
    tracker->start(0, {100, 0.5, 20});
    EXPECT_TRUE(tracker->advance(0.2, Measurement{102, 0.5, 10}));
    EXPECT_FALSE(tracker->advance(0.4, Measurement{101, 0.1, 9}));
    EXPECT_DOUBLE_EQ(tracker->pose().along_m, 104);
  }
}

TEST(PaperTracker, PredictsWithTheMotionModel) {  // Eq. 16
  const auto tracker = make_paper_tracker({});
  tracker->start(0, {100, 0.5, 20});
  tracker->advance(0.2, Measurement{102, 0.5, 20});
  EXPECT_FALSE(tracker->advance(0.4, std::nullopt));
  EXPECT_NEAR(tracker->pose().along_m, 104, 1e-9);
  EXPECT_GT(tracker->pose().sigma_m, 0.5);
}

TEST(PaperTracker, FiltersAfterTheFirstFrames) {  // section 4.2.4
  PaperTrackerSettings settings;
  settings.first_frames = 3;
  settings.weight_within = 1;
  const auto tracker = make_paper_tracker(settings);
  tracker->start(0, {100, 0.5, 20});
  tracker->advance(0.2, Measurement{102, 0.5, 20});
  tracker->advance(0.4, Measurement{104, 0.5, 20});
  tracker->advance(0.6, Measurement{106.5, 0.5, 20});
  EXPECT_GT(tracker->pose().along_m, 106.1);
  EXPECT_LT(tracker->pose().along_m, 106.4);
}

TEST(PaperTracker, StartsAnewWithoutAVelocity) {
  const PaperTrackerSettings settings;
  const auto tracker = make_paper_tracker(settings);
  tracker->start(0, {100, 0.5, 20});
  for (int k = 1; k < 6; ++k) tracker->advance(0.2 * k, Measurement{100 + 2.0 * k, 0.5, 20});
  tracker->start(10, {50, 0.5, 20});
  const AlongRange region = tracker->search_region(10.2);
  EXPECT_DOUBLE_EQ(region.from_m, 50 - settings.min_region_m);
  EXPECT_NEAR(region.to_m, 50 + 0.2 * settings.max_speed_mps + settings.min_region_m, 1e-9);
  tracker->advance(10.2, Measurement{53, 0.5, 20});
  EXPECT_DOUBLE_EQ(tracker->pose().along_m, 53);
}

TEST(PaperTracker, AVehicleOnItsWayDoesNotGoBack) {
  const auto tracker = make_paper_tracker({});
  tracker->start(0, {100, 0.5, 20});
  tracker->advance(0.2, Measurement{98, 0.5, 20});
  EXPECT_DOUBLE_EQ(tracker->predict(0.4).along_m, 98);
}

TEST(MotionTracker, LearnsTheSpeed) {
  const auto tracker = make_motion_tracker({});
  tracker->start(0, {100, 0.1, 20});
  for (int k = 1; k <= 10; ++k) tracker->advance(0.2 * k, Measurement{100 + 3.0 * k, 0.1, 20});
  EXPECT_NEAR(tracker->predict(2.2).along_m, 133, 0.1);
  EXPECT_LT(tracker->pose().sigma_m, 0.1);
}

TEST(MotionTracker, RefusesAnOutlierButNotForEver) {
  MotionTrackerSettings settings;
  settings.max_refusals = 3;
  const auto tracker = make_motion_tracker(settings);
  tracker->start(0, {100, 0.1, 20});
  for (int k = 1; k <= 10; ++k) tracker->advance(0.2 * k, Measurement{100 + 3.0 * k, 0.1, 20});
  EXPECT_FALSE(tracker->advance(2.2, Measurement{160, 0.1, 20}));
  EXPECT_NEAR(tracker->pose().along_m, 133, 0.1);
  EXPECT_FALSE(tracker->advance(2.4, Measurement{163, 0.1, 20}));
  EXPECT_TRUE(tracker->advance(2.6, Measurement{166, 0.1, 20}));
  EXPECT_NEAR(tracker->pose().along_m, 166, 0.1);
}

TEST(MotionTracker, SearchesWiderTheLessItKnows) {
  const auto tracker = make_motion_tracker({});
  tracker->start(0, {100, 0.1, 20});
  const AlongRange unsure = tracker->search_region(0.4);
  for (int k = 1; k <= 10; ++k) tracker->advance(0.2 * k, Measurement{100 + 3.0 * k, 0.1, 20});
  const AlongRange sure = tracker->search_region(2.4);
  EXPECT_GT(unsure.to_m - unsure.from_m, 2 * (sure.to_m - sure.from_m));
  EXPECT_TRUE(sure.contains(136));
}

}  // namespace
}  // namespace milepost
