#include "client/global/camera_motion.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include <Eigen/Geometry>

#include "schema/geo/camera_pose.h"
#include "schema/geo/geodesy.h"

namespace milepost {
namespace {

// Odometry and camera poses agree: a point ahead and to the right, before and after a turn.
TEST(CameraMotion, IsThatOfALevelCamera) {
  const OdometryIncrement odometry{1, 3, 0.4};
  const Eigen::Isometry3d motion = camera_motion(odometry);
  CameraPose before;
  before.heading_rad = 1.1;
  const Pose2 after_plan = moved({{0, 0}, 1.1}, 3, 0.4);
  CameraPose after;
  after.enu_m = {after_plan.enu_m.x(), after_plan.enu_m.y(), 0};
  after.heading_rad = after_plan.heading_rad;
  const Eigen::Vector3d point(12, 9, 2);
  const Eigen::Vector3d expected = point_in_camera(after, point);
  const Eigen::Vector3d is = motion.inverse() * point_in_camera(before, point);
  EXPECT_TRUE(is.isApprox(expected, 1e-9)) << is.transpose() << " not " << expected.transpose();
}

// Points observed before and after a motion, with noise and some outliers.
std::vector<RayPair> pairs_of(const Eigen::Isometry3d& motion, double sigma, int count, int wrong,
                              double away_m = 15) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-1, 1);
  std::normal_distribution<double> noise(0, sigma);
  std::vector<RayPair> pairs;
  for (int i = 0; i < count; ++i) {
    const double depth_m = away_m + 10 * place(random);
    const Eigen::Vector3d point(0.7 * depth_m * place(random), 0.5 * depth_m * place(random),
                                depth_m);
    const Eigen::Vector3d now = motion.inverse() * point;
    RayPair pair{point / point.z(), now / now.z()};
    for (int axis = 0; axis < 2; ++axis) {
      pair.before[axis] += noise(random);
      pair.now[axis] += i < wrong ? 0.1 * place(random) : noise(random);
    }
    pairs.push_back(pair);
  }
  return pairs;
}

double degrees_between(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  return Eigen::AngleAxisd(a * b.transpose()).angle() / kRadPerDeg;
}

TEST(EpipolarDistance, IsZeroForStaticPoints) {
  const Eigen::Isometry3d motion = camera_motion({1, 2, 0.1});
  for (const RayPair& pair : pairs_of(motion, 0, 50, 0)) {
    EXPECT_NEAR(epipolar_distance(pair, motion), 0, 1e-12);
  }
}

// Sampson's distance: the error is split between both rays.
TEST(EpipolarDistance, IsTheRaysOwn) {
  const Eigen::Isometry3d ahead(Eigen::Translation3d(0, 0, 0.01));
  const RayPair pair{{0.2, 0, 1}, {0.2, 0.003, 1}};
  EXPECT_NEAR(std::abs(epipolar_distance(pair, ahead)), 0.003 / std::sqrt(2), 1e-5);
}

TEST(EpipolarDistance, IsZeroWithoutTranslation) {
  EXPECT_EQ(epipolar_distance({{0.2, 0.1, 1}, {0.3, 0.1, 1}}, Eigen::Isometry3d::Identity()), 0);
}

TEST(RefinedMotion, CorrectsOdometry) {
  const OdometryIncrement odometry{0.2, 2, 0.05};
  Eigen::Isometry3d truth = camera_motion(odometry);
  // A bump, a yaw that odometry missed, a camera that looks slightly down and to the left.
  truth.rotate(Eigen::AngleAxisd(0.012, Eigen::Vector3d::UnitY()))
      .rotate(Eigen::AngleAxisd(-0.008, Eigen::Vector3d::UnitX()));
  truth.translation() = Eigen::AngleAxisd(0.03, Eigen::Vector3d::UnitX()) * truth.translation();
  const Eigen::Isometry3d start = camera_motion(odometry);
  const Eigen::Isometry3d refined = refined_motion(pairs_of(truth, 0.002, 300, 60), start, 0.002);
  EXPECT_GT(degrees_between(start.linear(), truth.linear()), 0.8);
  EXPECT_LT(degrees_between(refined.linear(), truth.linear()), 0.08);
  EXPECT_NEAR(refined.translation().norm(), 2, 1e-9);
  EXPECT_LT(std::acos(refined.translation().dot(truth.translation()) / 4) / kRadPerDeg, 0.6);
}

// A sideways translation hardly moves distant points: their noise must not be attributed to it.
TEST(RefinedMotion, UnobservableMotionIsThatOfOdometry) {
  const Eigen::Isometry3d start = camera_motion({0.2, 1, 0});
  const std::vector<RayPair> pairs = pairs_of(start, 0.002, 30, 0, 2000);
  const Eigen::Isometry3d refined = refined_motion(pairs, start, 0.002);
  EXPECT_LT(std::acos(refined.translation().normalized().z()) / kRadPerDeg, 4);
  EXPECT_LT(degrees_between(refined.linear(), start.linear()), 0.3);
}

TEST(RefinedMotion, WithoutPairsItIsThatOfOdometry) {
  const Eigen::Isometry3d start = camera_motion({0.2, 2, 0.05});
  const Eigen::Isometry3d refined = refined_motion({}, start, 0.002);
  EXPECT_TRUE(refined.linear().isApprox(start.linear()));
  EXPECT_TRUE(refined.translation().isApprox(start.translation()));
}

}  // namespace
}  // namespace milepost
