// The localizer with landmarks, on a road with known landmarks.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <thread>

#include "client/localize/localizer.h"
#include "tests/client/localize/landmark_road.h"

namespace milepost {
namespace {

using testing::LandmarkRoad;
using testing::RoadPose;

constexpr double kFrameM = 1;      // between frames ...
constexpr double kSpeedMps = 10;   // ... at this speed
constexpr double kLaneFromM = 40;  // from where the vehicle changes to a lane 3 m to the left ...
constexpr double kLaneToM = 80;    // ... which it reaches here

// A smooth lane change.
RoadPose drive_at(double along_m) {
  const double part = std::clamp((along_m - kLaneFromM) / (kLaneToM - kLaneFromM), 0.0, 1.0);
  const double lateral_m = -1.5 * (1 - std::cos(part * M_PI));
  const double slope = -1.5 * std::sin(part * M_PI) * M_PI / (kLaneToM - kLaneFromM);
  return {along_m, lateral_m, std::atan(slope) * 180 / M_PI};
}

double angle_between_deg(double a_deg, double b_deg) {
  return std::abs(std::remainder(a_deg - b_deg, 360));
}

class TrackingByLandmarks : public ::testing::Test {
 protected:
  static const LandmarkRoad& road() { return testing::shared_road(); }

  static LocalizerSettings settings() {
    LocalizerSettings settings = testing::settings_of_a_short_reach();
    settings.method_settings.reach = {5, 5};  // so that the source is used often
    return settings;
  }

  // GNSS gives the start to 8 m, and nothing later.
  void begin_at(double along_m) {
    time_s_ = 100;
    localizer_.observe({time_s_, road().line().point_at(along_m + 3), 8});
    fix(along_m);
  }

  // The fix of the next frame.
  Fix fix(double along_m, bool blind = false) {
    truth_ = drive_at(along_m);
    return fix_from_truth(blind);
  }

  Fix fix_from_truth(bool blind = false) {
    const FeatureSet set = blind ? FeatureSet() : road().observe(truth_, mounting_deg_, random_);
    testing::wait_for_tiles(localizer_, time_s_);
    const auto fix = localizer_.localize(
        {time_s_, [&](const FeatureParameters&) -> const FeatureSet& { return set; }});
    time_s_ += kFrameM / kSpeedMps;
    EXPECT_TRUE(fix.ok()) << fix.error().line();
    return fix.ok() ? *fix : Fix();
  }

  void expect_tracked(const Fix& fix) const {
    ASSERT_EQ(fix.status, FixStatus::tracking) << "at " << truth_.along_m;
    EXPECT_NEAR(*fix.along_m, truth_.along_m, 0.08);
    EXPECT_NEAR(*fix.lateral_m, truth_.lateral_m, 0.06) << "at " << truth_.along_m;
    const LineProjection beside = road().line().project(*fix.position);
    EXPECT_NEAR(beside.along_m, *fix.along_m, 0.01);
    EXPECT_NEAR(beside.lateral_m, *fix.lateral_m, 0.01);
    EXPECT_LT(angle_between_deg(*fix.heading_deg, road().course_deg(truth_) + mounting_deg_), 0.25)
        << "at " << truth_.along_m;
    EXPECT_LT(fix.sigma_m, 0.1);
    EXPECT_LT(*fix.lateral_sigma_m, 0.1);
    EXPECT_GE(fix.matches, 20);
  }

  // Waits for the retries of all tiles whose request failed. False if that takes half a minute.
  bool waits_until_nothing_is_missing() {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    const auto is_complete = [&] {
      const auto held = localizer_.provider().held();
      return std::ranges::all_of(
          held->segments, [](const auto& segment) { return segment.second->missing.empty(); });
    };
    while (!is_complete() && std::chrono::steady_clock::now() < deadline) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return is_complete();
  }

  // Tracks from frame to frame, from `from_m` to before `to_m`.
  void expect_tracked_between(double from_m, double to_m) {
    for (double along_m = from_m; along_m < to_m; along_m += kFrameM) {
      expect_tracked(fix(along_m));
      if (HasFatalFailure()) return;
    }
  }

  std::shared_ptr<testing::MemorySource> map_ = testing::map_of(road());
  Localizer localizer_{map_, road().query_camera(), settings()};
  double mounting_deg_ = 0;
  double time_s_ = 0;
  RoadPose truth_;
  std::mt19937 random_{11};
};

TEST_F(TrackingByLandmarks, FindsTheStart) {
  time_s_ = 100;
  localizer_.observe({time_s_, road().line().point_at(33), 8});
  const Fix first = fix(30);
  EXPECT_EQ(first.status, FixStatus::initializing);
  ASSERT_TRUE(first.along_m && first.lateral_m);
  EXPECT_NEAR(*first.along_m, 30, 0.15);
  EXPECT_NEAR(*first.lateral_m, 0, 0.1);
  EXPECT_GE(first.matches, 20);
}

TEST_F(TrackingByLandmarks, FromBeforeTheRoadBegins) {
  time_s_ = 100;
  localizer_.observe({time_s_, road().line().point_at(0), 8});
  for (double along_m = -1.8; along_m < 5; along_m += 0.5) {
    truth_ = {along_m, -0.8, 0};
    const Fix fix = fix_from_truth();
    ASSERT_TRUE(fix.along_m && fix.lateral_m) << along_m;
    EXPECT_NEAR(*fix.along_m, std::max(0.0, along_m), 0.1);
    EXPECT_NEAR(*fix.lateral_m, -0.8, 0.1) << along_m;
  }
}

TEST_F(TrackingByLandmarks, AtAnEndOfTheMapSigmaIsWider) {
  LocalizerSettings everywhere_alike = settings();
  LandmarkMethod by_landmarks;
  by_landmarks.end_variance = 0;
  everywhere_alike.method = landmark_method(by_landmarks);
  Localizer other(map_, road().query_camera(), everywhere_alike);
  std::mt19937 random(3);
  std::map<double, double> ratios;
  for (double along_m = 0; along_m < 30; along_m += kFrameM, time_s_ += kFrameM / kSpeedMps) {
    const FeatureSet set = road().observe({along_m, 0, 0}, 0, random);
    const auto features = [&](const FeatureParameters&) -> const FeatureSet& { return set; };
    std::vector<double> sigmas_m;
    for (Localizer* localizer : {&localizer_, &other}) {
      if (along_m == 0) localizer->observe({time_s_, road().line().point_at(2), 8});
      testing::wait_for_tiles(*localizer, time_s_);
      sigmas_m.push_back(localizer->localize({time_s_, features})->sigma_m);
    }
    ratios[along_m] = sigmas_m[0] / sigmas_m[1];
  }
  EXPECT_GT(ratios[2], 1.5);
  EXPECT_GT(ratios[2], ratios[6]);
  EXPECT_NEAR(ratios[25], 1, 0.1);
}

TEST_F(TrackingByLandmarks, ThroughALaneChange) {
  begin_at(30);
  expect_tracked_between(31, 100);
  EXPECT_NEAR(truth_.lateral_m, -3, 1e-9);
}

// 540 m: the tangent frame is recentered during the drive, through the bend.
TEST_F(TrackingByLandmarks, AlongTheWholeRoad) {
  begin_at(10);
  expect_tracked_between(11, 550);
}

TEST_F(TrackingByLandmarks, WithACameraThatLooksAside) {
  mounting_deg_ = 2;
  begin_at(30);
  expect_tracked_between(31, 130);
  // The estimated mounting keeps the prediction straight: 2 degrees over 7 m would be 0.24 m.
  Fix blind;
  for (double along_m = 130; along_m < 137; along_m += kFrameM) blind = fix(along_m, true);
  EXPECT_EQ(blind.status, FixStatus::predicted);
  EXPECT_NEAR(*blind.lateral_m, truth_.lateral_m, 0.12);
}

TEST_F(TrackingByLandmarks, PredictsThroughABlackout) {
  begin_at(100);
  expect_tracked_between(101, 130);
  double sigma_m = 0;
  double lateral_sigma_m = 0;
  for (double along_m = 130; along_m < 137; along_m += kFrameM) {
    const Fix blind = fix(along_m, true);
    EXPECT_EQ(blind.status, FixStatus::predicted);
    EXPECT_EQ(blind.matches, 0);
    EXPECT_NEAR(*blind.along_m, along_m, 3 * blind.sigma_m);
    EXPECT_NEAR(*blind.lateral_m, -3, 3 * *blind.lateral_sigma_m);
    EXPECT_GT(blind.sigma_m, sigma_m);
    EXPECT_GT(*blind.lateral_sigma_m, lateral_sigma_m);
    sigma_m = blind.sigma_m;
    lateral_sigma_m = *blind.lateral_sigma_m;
  }
  EXPECT_LT(sigma_m, 2);
  expect_tracked_between(137, 150);
}

TEST_F(TrackingByLandmarks, OdometryGivesTheInitialSpeed) {
  localizer_.observe(Odometry{99.9, 10, 0});
  begin_at(100);
  const Fix blind = fix(101, true);
  EXPECT_EQ(blind.status, FixStatus::initializing);  // one frame is not enough to accept
  ASSERT_TRUE(blind.along_m);
  EXPECT_NEAR(*blind.along_m, 101, 0.15);
}

// Half a second at 10 m/s, then blind at 4 m/s, which only odometry shows.
TEST_F(TrackingByLandmarks, OdometryBridgesABlackout) {
  begin_at(100);
  double along_m = 101;
  for (; along_m < 110; along_m += kFrameM) {
    localizer_.observe(Odometry{time_s_ - 0.02, 10, 0});
    expect_tracked(fix(along_m));
  }
  along_m -= kFrameM;  // the current position
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  Fix blind;
  for (int i = 0; i < 7; ++i) {
    along_m += 0.4;
    localizer_.observe(Odometry{time_s_ - 0.09, 4, 0});
    localizer_.observe(Odometry{time_s_ - 0.1, 40, 0});  // out of order, so ignored
    localizer_.observe(Odometry{time_s_ - 0.01, nothing, 0});
    blind = fix(along_m, true);
    EXPECT_EQ(blind.status, FixStatus::predicted);
  }
  EXPECT_NEAR(*blind.along_m, along_m, 3 * blind.sigma_m);
  EXPECT_LT(blind.sigma_m, 0.15);
}

// Frames at intervals of two seconds, three of which are blind: 80 m without a measurement.
TEST_F(TrackingByLandmarks, PredictsThroughALongBlackout) {
  begin_at(100);
  expect_tracked_between(101, 120);
  for (double along_m = 139; along_m < 180; along_m += 20) {
    time_s_ += 19 / kSpeedMps;
    const Fix blind = fix(along_m, true);
    EXPECT_EQ(blind.status, FixStatus::predicted);
    EXPECT_NEAR(*blind.along_m, along_m, 5);
  }
}

TEST_F(TrackingByLandmarks, IsLostAndFoundAgain) {
  begin_at(80);  // four seconds before, so that the GNSS fix is too old to help
  expect_tracked_between(81, 120);
  double along_m = 120;
  Fix last;
  int predicted = -1;
  for (; last.status != FixStatus::lost && along_m < 400; along_m += kFrameM, ++predicted)
    last = fix(along_m, true);
  EXPECT_GT(predicted, LocalizerSettings().max_predicted_frames);
  EXPECT_EQ(last.status, FixStatus::lost);
  EXPECT_FALSE(last.along_m || last.lateral_m || last.heading_deg);
  EXPECT_EQ(fix(along_m + kFrameM, true).status, FixStatus::lost);
  expect_tracked_between(along_m + 2 * kFrameM, along_m + 20);
}

TEST_F(TrackingByLandmarks, DrivesOnWhileTheSourceFails) {
  begin_at(100);
  expect_tracked_between(101, 120);
  EXPECT_FALSE(localizer_.last_error());
  map_->be_unavailable();
  int predicted = 0;
  double along_m = 120;
  for (; predicted < 3 && along_m < 200; along_m += kFrameM) {
    const Fix on = fix(along_m);
    if (on.status == FixStatus::tracking) continue;  // with the data held
    EXPECT_EQ(on.status, FixStatus::predicted);
    EXPECT_NEAR(*on.along_m, along_m, 3 * on.sigma_m);
    ++predicted;
  }
  EXPECT_EQ(predicted, 3);
  ASSERT_TRUE(localizer_.last_error());
  EXPECT_EQ(localizer_.last_error()->code, ErrorCode::unavailable);
  map_->be_unavailable(false);
  ASSERT_TRUE(waits_until_nothing_is_missing());
  expect_tracked_between(along_m, along_m + 10);
}

// The road cut into segments, one of which is shorter than a frame's step and its overlap.
class ThroughJunctions : public TrackingByLandmarks {
 protected:
  void SetUp() override {
    map_ = testing::map_of(road(), kCutsM);
    localizer_ = Localizer(map_, road().query_camera(), settings());
  }

  // On the whole road.
  double way_m(const Fix& fix) const { return std::stod(fix.segment.substr(5)) + *fix.along_m; }

  inline static const std::vector<double> kCutsM = {60, 120, 126, 260, 400};
};

TEST_F(ThroughJunctions, ThePoseGoesOnWithoutAReceiver) {
  begin_at(20);
  for (double along_m = 21; along_m < 450; along_m += kFrameM) {
    const Fix fix = this->fix(along_m);
    if (along_m < 26) continue;  // until it is claimed
    ASSERT_EQ(fix.status, FixStatus::tracking) << "at " << along_m;
    EXPECT_NEAR(way_m(fix), along_m, 0.08);
    EXPECT_NEAR(*fix.lateral_m, truth_.lateral_m, 0.06) << "at " << along_m;
    EXPECT_LT(fix.sigma_m, 0.1) << "at " << along_m;
    EXPECT_GE(fix.matches, 20) << "at " << along_m;
  }
}

TEST_F(ThroughJunctions, SegmentsFollowEachOtherAndNoneComesBack) {
  begin_at(20);
  std::vector<std::string> driven;
  for (double along_m = 21; along_m < 450; along_m += kFrameM) {
    const Fix fix = this->fix(along_m);
    if (driven.empty() || driven.back() != fix.segment) driven.push_back(fix.segment);
  }
  EXPECT_EQ(driven, (std::vector<std::string>{"road-0", "road-60", "road-120", "road-126",
                                              "road-260", "road-400"}));
}

TEST_F(ThroughJunctions, ABlindVehicleIsPredictedOntoTheNextSegment) {
  begin_at(40);
  for (double along_m = 41; along_m < 62; along_m += kFrameM) fix(along_m);
  for (double along_m = 62; along_m < 69; along_m += kFrameM) {
    const Fix blind = fix(along_m, true);
    EXPECT_EQ(blind.status, FixStatus::predicted) << "at " << along_m;
    EXPECT_NEAR(way_m(blind), along_m, 0.6) << "at " << along_m;
  }
  const Fix seeing = fix(69);
  EXPECT_EQ(seeing.status, FixStatus::tracking);
  EXPECT_EQ(seeing.segment, "road-60");
}

// Farther ahead than the surroundings reach, and so known by the network only.
TEST_F(ThroughJunctions, WhatLiesBeyondAJunctionIsHeldAndStaysWanted) {
  LocalizerSettings far = settings();
  far.prefetch_m = 300;
  localizer_ = Localizer(map_, road().query_camera(), far);
  begin_at(20);
  for (double along_m = 21; along_m < 30; along_m += kFrameM) fix(along_m);
  for (double along_m = 30; along_m < 34; along_m += kFrameM) {
    fix(along_m);
    const auto held = localizer_.provider().held();
    const auto beyond = std::ranges::find_if(
        held->segments, [](const auto& segment) { return segment.first.segment == "road-260"; });
    ASSERT_NE(beyond, held->segments.end()) << "at " << along_m;
    ASSERT_NE(beyond->second->layer, nullptr) << "at " << along_m;
    EXPECT_TRUE(
        std::ranges::any_of(localizer_.provider().wanted().tiles,
                            [&](const Want& want) { return want.segment == beyond->first; }))
        << "at " << along_m;
  }
}

TEST_F(ThroughJunctions, AFixIsToldForATimeBeyondTheNextJunction) {
  begin_at(40);
  for (double along_m = 41; along_m < 58; along_m += kFrameM) fix(along_m);
  const Fix later = localizer_.fix_at(time_s_ + 1.5);  // 73 m, 8 m beyond the segment
  EXPECT_EQ(later.status, FixStatus::predicted);
  EXPECT_EQ(later.segment, "road-0");
  EXPECT_NEAR(later.position->latitude_deg, road().line().point_at(73).latitude_deg, 1e-5);
}

}  // namespace
}  // namespace milepost
