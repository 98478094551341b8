#include "client/find/scene_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace milepost {
namespace {

const Pinhole kView{360, 360, 300, 250};
constexpr double kWallM = 14;      // across the way, before the first camera
constexpr double kPixelPerM = 60;  // of its picture

// A wall full of spots of all sizes, 60 m wide and 40 m high.
cv::Mat painted_wall() {
  cv::Mat wall(static_cast<int>(40 * kPixelPerM), static_cast<int>(60 * kPixelPerM), CV_8UC1,
               cv::Scalar(128));
  cv::RNG random(4);
  for (int i = 0; i < 9000; ++i) {
    const cv::Point at(random.uniform(0, wall.cols), random.uniform(0, wall.rows));
    const int size = random.uniform(4, 40);
    cv::rectangle(wall, {at.x, at.y, size, random.uniform(4, 40)}, random.uniform(0, 255),
                  cv::FILLED);
  }
  cv::GaussianBlur(wall, wall, {0, 0}, 1.5);
  return wall;
}

// The wall as a camera sees it that went ahead by `ahead_m` and turned right by `turn_rad`.
cv::Mat seen(const cv::Mat& wall, double ahead_m, double turn_rad) {
  Eigen::Matrix3d camera_from_first =
      Eigen::AngleAxisd(-turn_rad, Eigen::Vector3d::UnitY()).toRotationMatrix();
  // A point x, y of the wall's picture lies at ((x, y) - middle) / kPixelPerM, kWallM ahead.
  Eigen::Matrix3d first_from_picture;
  first_from_picture << 1 / kPixelPerM, 0, -30, 0, 1 / kPixelPerM, -20, 0, 0, kWallM - ahead_m;
  Eigen::Matrix3d pixel_from_camera;
  pixel_from_camera << kView.focal_x_px, 0, kView.principal_x_px, 0, kView.focal_y_px,
      kView.principal_y_px, 0, 0, 1;
  const Eigen::Matrix3d h = pixel_from_camera * camera_from_first * first_from_picture;
  cv::Mat homography(3, 3, CV_64F);
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) homography.at<double>(r, c) = h(r, c);
  }
  cv::Mat image;
  cv::warpPerspective(wall, image, homography, {600, 500}, cv::INTER_AREA);
  return image;
}

double median(std::vector<double> values) {
  std::ranges::nth_element(values, values.begin() + static_cast<long>(values.size() / 2));
  return values[values.size() / 2];
}

TEST(ScenePoints, StandAsFarAsTheWallIs) {
  const cv::Mat wall = painted_wall();
  ScenePointTracker tracker(kView, {});
  EXPECT_TRUE(tracker.observe(seen(wall, 0, 0), {}).empty());
  // The wheels missed some of the turn.
  tracker.observe(seen(wall, 1, 0.02), {0.2, 1, 0.015});
  const auto points = tracker.observe(seen(wall, 2, 0.04), {0.2, 1, 0.018});
  ASSERT_GT(points.size(), 100U);
  std::vector<double> off_m;
  std::vector<double> off_sigmas;
  for (const ScenePoint& point : points) {
    // Its distance before the first camera's plane.
    const double ahead_m =
        point.camera_m.z() * std::cos(0.04) - point.camera_m.x() * std::sin(0.04) + 2;
    off_m.push_back(std::abs(ahead_m - kWallM));
    off_sigmas.push_back(std::abs(ahead_m - kWallM) / point.range_sigma_m);
    EXPECT_LE(point.range_sigma_m, 0.2 * point.camera_m.norm());
  }
  EXPECT_LT(median(off_m), 0.5);
  EXPECT_LT(median(off_sigmas), 1.5);
}

TEST(ScenePoints, StandingStillTellsNothing) {
  const cv::Mat wall = painted_wall();
  ScenePointTracker tracker(kView, {});
  tracker.observe(seen(wall, 0, 0), {});
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(tracker.observe(seen(wall, 0, 0), {0.2, 0.01, 0}).empty());
  }
  // The short steps add up.
  EXPECT_FALSE(tracker.observe(seen(wall, 1, 0), {0.2, 0.97, 0}).empty());
  // What is known by now is not told again.
  EXPECT_TRUE(tracker.observe(seen(wall, 1, 0), {0.2, 0.01, 0}).empty());
}

TEST(ScenePoints, AFrameWithoutFeaturesIsDrivenOver) {
  const cv::Mat wall = painted_wall();
  const cv::Mat grey(500, 600, CV_8UC1, cv::Scalar(90));
  ScenePointTracker tracker(kView, {});
  tracker.observe(seen(wall, 0, 0), {});
  EXPECT_TRUE(tracker.observe(grey, {0.2, 1, 0}).empty());
  EXPECT_TRUE(tracker.observe(seen(wall, 2, 0), {0.2, 1, 0}).empty());
  EXPECT_GT(tracker.observe(seen(wall, 3, 0), {0.2, 1, 0}).size(), 50U);
}

}  // namespace
}  // namespace milepost
