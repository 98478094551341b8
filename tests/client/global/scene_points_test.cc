#include "client/global/scene_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "tests/client/global/painted_wall.h"

namespace milepost {
namespace {

using testing::kCamera;
using testing::kView;
using testing::kWallM;
using testing::painted_wall;
using testing::seen;

double median(std::vector<double> values) {
  std::ranges::nth_element(values, values.begin() + static_cast<long>(values.size() / 2));
  return values[values.size() / 2];
}

std::vector<double> ahead_of(const std::vector<ScenePoint>& points) {
  std::vector<double> ahead_m;
  ahead_m.reserve(points.size());
  for (const ScenePoint& point : points) ahead_m.push_back(point.camera_m.z());
  return ahead_m;
}

TEST(ScenePoints, StandAsFarAsTheWallIs) {
  const cv::Mat wall = painted_wall();
  ScenePointTracker tracker(kCamera, {});
  EXPECT_TRUE(tracker.observe(seen(wall, 0, 0), {}).empty());
  // Odometry missed some of the turn.
  tracker.observe(seen(wall, 1, 0.02), {0.2, 1, 0.015});
  const auto points = tracker.observe(seen(wall, 2, 0.04), {0.2, 1, 0.018});
  ASSERT_GT(points.size(), 100U);
  std::vector<double> off_m;
  std::vector<double> off_sigmas;
  for (const ScenePoint& point : points) {
    // The distance in front of the first camera's plane.
    const double ahead_m =
        point.camera_m.z() * std::cos(0.04) - point.camera_m.x() * std::sin(0.04) + 2;
    off_m.push_back(std::abs(ahead_m - kWallM));
    off_sigmas.push_back(std::abs(ahead_m - kWallM) / point.range_sigma_m);
    EXPECT_LE(point.range_sigma_m, 0.2 * point.camera_m.norm());
  }
  EXPECT_LT(median(off_m), 0.5);
  EXPECT_LT(median(off_sigmas), 1.5);
}

TEST(ScenePoints, AWallNearbyIsSeenToo) {
  const cv::Mat wall = painted_wall();
  ScenePointTracker tracker(kCamera, {});
  tracker.observe(seen(wall, kWallM - 4, 0), {});
  tracker.observe(seen(wall, kWallM - 3.5, 0), {0.2, 0.5, 0});
  const auto points = tracker.observe(seen(wall, kWallM - 3, 0), {0.2, 0.5, 0});
  ASSERT_GT(points.size(), 100U);
  EXPECT_NEAR(median(ahead_of(points)), 3, 0.1);
}

TEST(ScenePoints, ShortStepsAddUp) {
  const cv::Mat wall = painted_wall();
  ScenePointTracker tracker(kCamera, {});
  tracker.observe(seen(wall, 0, 0), {});
  std::size_t most = 0;
  for (int i = 1; i <= 4; ++i) {
    most = std::max(most, tracker.observe(seen(wall, 0.25 * i, 0), {0.1, 0.25, 0}).size());
  }
  EXPECT_GT(most, 100U);
}

// Points that come into view are tracked from there on.
TEST(ScenePoints, ATurnOnTheSpotBringsNewPoints) {
  const cv::Mat wall = painted_wall();
  ScenePointTracker tracker(kCamera, {});
  tracker.observe(seen(wall, 0, -1.2), {});
  for (int i = 11; i >= 0; --i) tracker.observe(seen(wall, 0, -0.1 * i), {0.2, 0, 0.1});
  const auto points = tracker.observe(seen(wall, 1, 0), {0.2, 1, 0});
  ASSERT_GT(points.size(), 100U);
  EXPECT_NEAR(median(ahead_of(points)), kWallM - 1, 0.5);
}

// Windows in a row look alike: few are mistaken for their neighbours.
TEST(ScenePoints, WhatLooksAlikeIsSeldomMistaken) {
  cv::Mat wall(40 * 60, 60 * 60, CV_8UC1, cv::Scalar(200));
  for (int y = 20; y < wall.rows; y += 90) {
    for (int x = 20; x < wall.cols; x += 60) {
      cv::rectangle(wall, {x, y, 30, 50}, 40, cv::FILLED);
      cv::rectangle(wall, {x + 5, y + 5, 8, 20}, 120, cv::FILLED);
    }
  }
  cv::GaussianBlur(wall, wall, {0, 0}, 1.5);
  ScenePointTracker tracker(kCamera, {});
  tracker.observe(seen(wall, 0, 0), {});
  const auto points = tracker.observe(seen(wall, 2, 0), {0.2, 2, 0});
  int wrong = 0;
  for (const ScenePoint& point : points) {
    wrong += std::abs(point.camera_m.z() - (kWallM - 2)) > 4 ? 1 : 0;
  }
  ASSERT_GT(points.size(), 100U);
  EXPECT_LT(wrong, 0.22 * static_cast<double>(points.size()));
}

// Longer than the distance to the nearest points that are searched.
TEST(ScenePoints, LongStepsAreFollowed) {
  const cv::Mat wall = painted_wall();
  ScenePointTracker tracker(kCamera, {});
  tracker.observe(seen(wall, 0, 0), {});
  EXPECT_GT(tracker.observe(seen(wall, 3, 0), {0.2, 3, 0}).size(), 100U);
}

// An object in front of the wall that moves down by half a degree per frame.
TEST(ScenePoints, WhatMovesIsLeftOut) {
  const cv::Mat wall = painted_wall();
  const cv::Mat patch = wall(cv::Rect(700, 300, 150, 150));
  ScenePointTracker tracker(kCamera, {});
  std::vector<ScenePoint> points;
  for (int frame = 0; frame < 2; ++frame) {
    cv::Mat image = seen(wall, frame, 0);
    patch.copyTo(image(cv::Rect(400, 150 + 6 * frame, 150, 150)));
    points = tracker.observe(image, {0.2, static_cast<double>(frame), 0});
  }
  int of_patch = 0;
  for (const ScenePoint& point : points) {
    const Eigen::Vector2d at = kView.project(point.camera_m);
    of_patch += at.x() > 420 && at.x() < 530 && at.y() > 180 && at.y() < 280 ? 1 : 0;
  }
  EXPECT_GT(points.size(), 100U);
  EXPECT_LT(of_patch, 8);
}

TEST(ScenePoints, StandingStillTellsNothing) {
  const cv::Mat wall = painted_wall();
  ScenePointTracker tracker(kCamera, {});
  tracker.observe(seen(wall, 0, 0), {});
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(tracker.observe(seen(wall, 0, 0), {0.2, 0.01, 0}).empty());
  }
  // The short steps add up.
  EXPECT_FALSE(tracker.observe(seen(wall, 1, 0), {0.2, 0.97, 0}).empty());
  // Points already reported are not repeated.
  EXPECT_TRUE(tracker.observe(seen(wall, 1, 0), {0.2, 0.01, 0}).empty());
}

TEST(ScenePoints, AFrameWithoutFeaturesIsDrivenOver) {
  const cv::Mat wall = painted_wall();
  const cv::Mat grey(500, 600, CV_8UC1, cv::Scalar(90));
  ScenePointTracker tracker(kCamera, {});
  tracker.observe(seen(wall, 0, 0), {});
  EXPECT_TRUE(tracker.observe(grey, {0.2, 1, 0}).empty());
  EXPECT_TRUE(tracker.observe(seen(wall, 2, 0), {0.2, 1, 0}).empty());
  EXPECT_GT(tracker.observe(seen(wall, 3, 0), {0.2, 1, 0}).size(), 50U);
}

}  // namespace
}  // namespace milepost
