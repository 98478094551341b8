// The localizer while the map loads in the background: no frame accesses the source or waits for
// it.
#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "client/localize/localizer.h"
#include "tests/client/localize/landmark_road.h"

namespace milepost {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;
using testing::LandmarkRoad;

constexpr double kFrameSpacingM = 1;
constexpr double kDrivenMps = 10;

class NeverWaits : public ::testing::Test {
 protected:
  static const LandmarkRoad& road() { return testing::shared_road(); }

  static LocalizerSettings settings(double ahead_m) {
    LocalizerSettings settings;
    settings.prefetch_m = ahead_m;
    settings.provider.backoff.first_s = 0.01;
    return settings;
  }

  // The fix of the next frame with the data held.
  Fix fix(double along_m) {
    const FeatureSet set = road().observe({along_m, 0, 0}, 0, random_);
    localizer_->observe({time_s_, road().line().point_at(along_m), 5});
    const auto fix = localizer_->localize(
        {time_s_, [&](const FeatureParameters&) -> const FeatureSet& { return set; }});
    time_s_ += kFrameSpacingM / kDrivenMps;
    return fix.ok() ? *fix : Fix();
  }

  // Drives from 50 m on until the hypothesis is accepted, as fast as the map loads.
  double track() {
    double along_m = 50;
    const auto deadline = steady_clock::now() + seconds(60);
    while (fix(along_m).status != FixStatus::tracking && steady_clock::now() < deadline) {
      std::this_thread::sleep_for(milliseconds(5));
      if (localizer_->fix_at(time_s_).status != FixStatus::initializing) along_m += kFrameSpacingM;
    }
    return along_m;
  }

  std::shared_ptr<testing::MemorySource> map_ = testing::map_of(road());
  std::optional<Localizer> localizer_;
  double time_s_ = 100;
  std::mt19937 random_{3};
};

TEST_F(NeverWaits, NoFrameEntersTheSource) {
  localizer_.emplace(map_, road().query_camera(), settings(300));
  double along_m = track();
  for (; along_m < 200; along_m += kFrameSpacingM) fix(along_m);
  EXPECT_GT(map_->tile_requests(), 0);
  EXPECT_FALSE(map_->callers().contains(std::this_thread::get_id()));
}

// In real time, 100 frames per second: the map ahead arrives before it is needed.
TEST_F(NeverWaits, FramesFindTheMapThatWasFetchedAhead) {
  localizer_.emplace(map_, road().query_camera(), settings(300));
  double along_m = track() + kFrameSpacingM;
  int tracked = 0;
  for (int i = 0; i < 300; ++i, along_m += kFrameSpacingM) {
    const Fix on = fix(along_m);
    if (on.status != FixStatus::tracking) continue;
    ++tracked;
    EXPECT_NEAR(*on.along_m, along_m, 0.1);
    std::this_thread::sleep_for(milliseconds(1));
  }
  EXPECT_EQ(tracked, 300);
}

// The source hangs during the drive: the held data is used to its end, then the motion is
// predicted; nothing waits.
TEST_F(NeverWaits, WhatIsHeldIsUsedToItsEndWhileTheSourceHangs) {
  localizer_.emplace(map_, road().query_camera(), settings(150));
  double along_m = track() + kFrameSpacingM;
  testing::wait_for_tiles(*localizer_, time_s_);
  map_->block();
  const int requests = map_->tile_requests();
  const double hung_at_m = along_m;
  double tracked_to_m = 0;
  Fix on;
  const auto began = steady_clock::now();
  for (; along_m < hung_at_m + 300; along_m += kFrameSpacingM) {
    on = fix(along_m);
    if (on.status != FixStatus::tracking) break;
    tracked_to_m = along_m;
  }
  EXPECT_LE(map_->tile_requests(), requests + 1);  // the one that hangs
  EXPECT_GT(tracked_to_m, hung_at_m + 140);
  EXPECT_LT(tracked_to_m, hung_at_m + 250);
  EXPECT_EQ(on.status, FixStatus::predicted);
  EXPECT_LT(steady_clock::now() - began, seconds(120));  // a hanging source never returns
  map_->block(false);
}

TEST_F(NeverWaits, EndsWhileTheSourceHangs) {
  map_->block();
  localizer_.emplace(map_, road().query_camera(), settings(300));
  for (int i = 0; i < 10; ++i) EXPECT_EQ(fix(50).status, FixStatus::initializing);
  const auto began = steady_clock::now();
  localizer_.reset();
  EXPECT_LT(steady_clock::now() - began, seconds(5));
}

TEST_F(NeverWaits, AFixCanBeAskedForAtALaterTime) {
  localizer_.emplace(map_, road().query_camera(), settings(300));
  double along_m = track() + kFrameSpacingM;
  Fix latest;
  for (int i = 0; i < 20; ++i, along_m += kFrameSpacingM) latest = fix(along_m);
  ASSERT_EQ(latest.status, FixStatus::tracking);
  const Fix now = localizer_->fix_at(latest.timestamp_s);
  EXPECT_NEAR(*now.along_m, *latest.along_m, 1e-6);
  const Fix later = localizer_->fix_at(latest.timestamp_s + 0.5);
  EXPECT_EQ(later.status, FixStatus::predicted);
  EXPECT_EQ(later.timestamp_s, latest.timestamp_s + 0.5);
  EXPECT_NEAR(*later.along_m, *latest.along_m + 0.5 * kDrivenMps, 0.3);
  EXPECT_GT(later.sigma_m, latest.sigma_m);
  ASSERT_TRUE(later.camera);
  EXPECT_GT(later.camera->covariance[0], latest.camera->covariance[0]);
  // The query changes nothing.
  EXPECT_NEAR(*localizer_->fix_at(latest.timestamp_s).along_m, *latest.along_m, 1e-6);
}

}  // namespace
}  // namespace milepost
