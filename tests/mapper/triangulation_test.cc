#include "mapper/landmarks/triangulation.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "tests/mapper/made_up_street.h"

namespace milepost {
namespace {

using testing::kStreetPinhole;
using testing::MadeUpStreet;

Eigen::Vector2d project(const Eigen::Vector3d& point, const CameraPose& pose) {
  return kStreetPinhole.project(point_in_camera(pose, point));
}

TEST(Triangulate, ExactBearingsGiveTheExactPoint) {
  MadeUpStreet street({.mounting_deg = 1.5, .tilt_deg = 2});
  int placed_points = 0;
  for (const auto& point : street.points) {
    const FeatureTrack track = street.observations_of(point);
    if (track.empty()) continue;
    const auto placed = triangulate(track, street.poses, kStreetPinhole, 1);
    ASSERT_TRUE(placed.has_value());
    EXPECT_LT((placed->enu_m - point.enu_m).norm(), 1e-5);
    EXPECT_LT(placed->rms_px, 1e-5);
    ++placed_points;
  }
  EXPECT_GT(placed_points, 200);
}

// Squared Mahalanobis errors have the mean of a chi-squared distribution of three degrees of
// freedom: 3, with a standard deviation of sqrt(6 / n) over n points. Squared residuals of m
// observations lack these three.
TEST(Triangulate, CovarianceAndRmsSayHowNoisyPixelsScatter) {
  MadeUpStreet street({.points = 2000, .tilt_deg = 2, .pixel_noise_px = 0.7, .farthest_m = 30});
  double sum = 0;
  double residuals_px2 = 0;
  double expected_px2 = 0;
  int count = 0;
  for (const auto& point : street.points) {
    const FeatureTrack track = street.observations_of(point);
    if (track.size() < 6) continue;  // farther points are not normally distributed
    const auto placed = triangulate(track, street.poses, kStreetPinhole, 0.7);
    ASSERT_TRUE(placed.has_value());
    const Eigen::Vector3d error = placed->enu_m - point.enu_m;
    sum += error.dot(placed->covariance_m2.inverse() * error);
    const auto observations = static_cast<double>(track.size());
    residuals_px2 += observations * placed->rms_px * placed->rms_px;
    expected_px2 += (2 * observations - 3) * 0.7 * 0.7;
    ++count;
  }
  ASSERT_GT(count, 500);
  EXPECT_NEAR(sum / count, 3, 4 * std::sqrt(6.0 / count));
  EXPECT_NEAR(residuals_px2 / expected_px2, 1, 0.05);
}

TEST(Triangulate, APointBehindTheCamerasIsNone) {
  const std::vector<CameraPose> poses = {{{0, 0, 0}, 0, 0, 0}, {{0, 2, 0}, 0, 0, 0}};
  // The rays intersect behind the camera, at the mirrored point.
  const FeatureTrack track = {{0, project({1, 10, 0.5}, poses[1])},
                              {1, project({1, 10, 0.5}, poses[0])}};
  EXPECT_FALSE(triangulate(track, poses, kStreetPinhole, 1).has_value());
}

TEST(Triangulate, ParallelRaysPlaceNothing) {
  const std::vector<CameraPose> poses = {
      {{0, 0, 0}, 0.3, 0, 0}, {{0.6, 1.9, 0}, 0.3, 0, 0}, {{1.2, 3.8, 0}, 0.3, 0, 0}};
  for (const double x_px : {300.0, 412.0, 77.5}) {
    for (const double y_px : {250.0, 10.0}) {
      const FeatureTrack track = {{0, {x_px, y_px}}, {1, {x_px, y_px}}, {2, {x_px, y_px}}};
      const auto placed = triangulate(track, poses, kStreetPinhole, 1);
      EXPECT_FALSE(placed.has_value())
          << x_px << " " << y_px << ": " << placed->enu_m.transpose() << "\n"
          << placed->covariance_m2;
    }
  }
}

TEST(Triangulate, ACameraThatStandsPlacesNothing) {
  const CameraPose pose{{5, 7, 1}, 0.3, 0.02, 0};
  const Eigen::Vector2d pixel(412, 170);
  EXPECT_FALSE(triangulate({{0, pixel}, {1, pixel}}, {pose, pose}, kStreetPinhole, 1).has_value());
}

}  // namespace
}  // namespace milepost
