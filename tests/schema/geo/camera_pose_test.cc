#include "schema/geo/camera_pose.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "schema/geo/geodesy.h"
#include "schema/geo/pinhole.h"
#include "schema/geo/ray_triangulation.h"

namespace milepost {
namespace {

constexpr Pinhole kCamera{400, 360, 320, 240};

// A camera 1.5 m above the origin.
CameraPose looking(double heading_deg, double pitch_deg = 0, double roll_deg = 0) {
  return {{0, 0, 1.5}, heading_deg * kRadPerDeg, pitch_deg * kRadPerDeg, roll_deg * kRadPerDeg};
}

Eigen::Vector2d pixel_seen(const CameraPose& pose, double east_m, double north_m, double up_m) {
  return kCamera.project<double>(point_in_camera<double>(pose, {east_m, north_m, up_m}));
}

void expect_pixel(const Eigen::Vector2d& pixel, double x_px, double y_px) {
  EXPECT_NEAR(pixel.x(), x_px, 1e-9);
  EXPECT_NEAR(pixel.y(), y_px, 1e-9);
}

// Ten metres ahead, two to the right, one above the camera: 320 + 400 * 2 / 10, 240 - 360 / 10.
TEST(CameraPose, ALevelCameraSeesWhatLiesToTheRightOnTheRight) {
  expect_pixel(pixel_seen(looking(0), 2, 10, 2.5), 400, 204);
  expect_pixel(pixel_seen(looking(90), 10, -2, 2.5), 400, 204);
  expect_pixel(pixel_seen(looking(180), -2, -10, 2.5), 400, 204);
  expect_pixel(pixel_seen(looking(270), -10, 2, 2.5), 400, 204);
}

TEST(CameraPose, PitchingUpMovesImagesDown) {
  // A point 10 degrees above the horizon projects to the principal point.
  const double up_m = 1.5 + 10 * std::tan(10 * kRadPerDeg);
  expect_pixel(pixel_seen(looking(90, 10), 10, 0, up_m), 320, 240);
  expect_pixel(pixel_seen(looking(90, 10), 10, 0, 1.5), 320, 240 + 360 * std::tan(10 * kRadPerDeg));
}

TEST(CameraPose, RollingClockwiseLiftsTheRight) {
  // 30 degrees: a point on the horizon, 2 in 10 to the right.
  const double r = 30 * kRadPerDeg;
  expect_pixel(pixel_seen(looking(0, 0, 30), 2, 10, 1.5), 320 + 400 * 0.2 * std::cos(r),
               240 - 360 * 0.2 * std::sin(r));
}

// FRAMES.md 7: heading about the camera's y, then pitch about its x, then roll about its z.
TEST(CameraPose, TurnsInTheOrderOfFrames7) {
  const CameraPose pose = looking(75, -4, 3);
  Eigen::Matrix3d enu_from_camera;  // of a level camera that looks north: right, down, forward
  enu_from_camera << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  enu_from_camera =
      enu_from_camera * (Eigen::AngleAxisd(75 * kRadPerDeg, Eigen::Vector3d::UnitY()) *
                         Eigen::AngleAxisd(-4 * kRadPerDeg, Eigen::Vector3d::UnitX()) *
                         Eigen::AngleAxisd(3 * kRadPerDeg, Eigen::Vector3d::UnitZ()))
                            .toRotationMatrix();
  EXPECT_LT((camera_from_enu(pose) - enu_from_camera.transpose()).norm(), 1e-12);
}

TEST(Pinhole, RayAndPixelUndoEachOther) {
  const Eigen::Vector3d ray = kCamera.unproject(100, 400);
  EXPECT_EQ(ray.z(), 1);
  expect_pixel(kCamera.project<double>(7 * ray), 100, 400);
  EXPECT_NEAR(kCamera.focal_px(), std::sqrt(400.0 * 360), 1e-12);
}

TEST(Pinhole, ItsDerivativeIsThatOfItsPixels) {
  const Eigen::Vector3d point(2, -1, 7);
  constexpr double kStep = 1e-6;
  const auto derivative = kCamera.projection_jacobian(point);
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(axis);
    const Eigen::Vector2d change =
        kCamera.project<double>(point + step) - kCamera.project<double>(point - step);
    EXPECT_LT((derivative.col(axis) - change / (2 * kStep)).norm(), 1e-6) << axis;
  }
}

TEST(CameraPose, IsFoundAgainFromItsTransform) {
  const CameraPose pose = {{3, -4, 1.5}, -2.1, 0.3, -0.2};
  const CameraPose again = pose_of(enu_from_camera(pose));
  EXPECT_LT((again.enu_m - pose.enu_m).norm(), 1e-12);
  EXPECT_NEAR(again.heading_rad, pose.heading_rad, 1e-12);
  EXPECT_NEAR(again.pitch_rad, pose.pitch_rad, 1e-12);
  EXPECT_NEAR(again.roll_rad, pose.roll_rad, 1e-12);
  const Eigen::Vector3d point(10, 20, 3);
  EXPECT_LT((enu_from_camera(pose) * point_in_camera(pose, point) - point).norm(), 1e-12);
}

TEST(RayTriangulation, MeetWhereTheyCross) {
  const Eigen::Vector3d crossing(1, 2, 10);
  RayTriangulation rays;
  for (const double x : {-1.0, 0.0, 3.0}) {
    const Eigen::Vector3d from(x, 0, 0);
    rays.add(from, (crossing - from).normalized(), 1 + x * x);
  }
  const auto met = rays.point();
  ASSERT_TRUE(met);
  EXPECT_LT((met->point_m - crossing).norm(), 1e-9);
}

TEST(RayTriangulation, DoNotMeetWhereTheyAreParallel) {
  RayTriangulation rays;
  rays.add({0, 0, 0}, {0, 0, 1});
  rays.add({1, 0, 0}, {0, 0, 1});
  EXPECT_FALSE(rays.point());
}

}  // namespace
}  // namespace milepost
