#include "client/global/range_likelihood.h"

#include <gtest/gtest.h>

#include <cmath>

#include <Eigen/Geometry>

#include "tests/client/global/plan_rooms.h"

namespace milepost {
namespace {

TEST(Beams, AreTheBestKnownPointsOfEachBearingOverTheCamerasHeight) {
  const std::vector<ScenePoint> points = {
      {{0, -2, 10}, 0.5},    // ahead
      {{0.1, -3, 10}, 0.2},  // ahead, more certain
      {{0.2, -4, 12}, 0.9},  // ahead, less certain
      {{5, -1, 5}, 0.1},     // to the right
      {{0, 0.5, 10}, 0.1},   // below the camera
      {{-60, -1, 60}, 0.1},  // too far
  };
  BeamSettings settings;
  settings.per_bin = 2;
  const std::vector<Beam> beams = beams_of(points, Eigen::Matrix3d::Identity(), settings);
  ASSERT_EQ(beams.size(), 3U);
  EXPECT_NEAR(beams[0].bearing_rad, 0.01, 1e-4);
  EXPECT_NEAR(beams[0].range_m, std::hypot(0.1, 10), 1e-9);
  EXPECT_NEAR(beams[0].range_sigma_m, 0.2 * std::hypot(0.1, 10) / std::sqrt(0.01 + 9 + 100), 1e-9);
  EXPECT_NEAR(beams[1].range_m, 10, 1e-9);
  EXPECT_NEAR(beams[2].bearing_rad, std::atan(1), 1e-9);
  EXPECT_NEAR(beams[2].range_m, std::hypot(5, 5), 1e-9);
}

TEST(Beams, AreLevelWhereTheCameraIsNot) {
  const Eigen::Matrix3d level_from_camera =
      Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()).toRotationMatrix();
  const std::vector<ScenePoint> points = {
      {level_from_camera.transpose() * Eigen::Vector3d(3, -2, 12), 0.1}};
  const std::vector<Beam> beams = beams_of(points, level_from_camera, {});
  ASSERT_EQ(beams.size(), 1U);
  EXPECT_NEAR(beams[0].bearing_rad, std::atan2(3, 12), 1e-9);
  EXPECT_NEAR(beams[0].range_m, std::hypot(3, 12), 1e-9);
}

// The observation of the walls from `pose`, one beam every 3 degrees.
std::vector<Beam> beams_at(const Pose2& pose, const RayCastingGrid& walls) {
  std::vector<Beam> beams;
  for (double bearing = -0.7; bearing < 0.7; bearing += 0.05) {
    const auto hit = walls.first_hit(pose.enu_m, direction_of(pose.heading_rad + bearing), 60);
    if (hit) beams.push_back({bearing, hit->range_m, 0.2});
  }
  return beams;
}

TEST(RangeLikelihood, IsBestWhereTheBeamsWereSeen) {
  const RayCastingGrid walls(testing::bent_street());
  const Pose2 truth{{1, 30}, 0.1};
  const std::vector<Beam> beams = beams_at(truth, walls);
  ASSERT_GT(beams.size(), 20U);
  const RangeLikelihood best = range_likelihood(truth, 1, beams, walls, {});
  EXPECT_NEAR(best.log_likelihood, 0, 1e-9);
  EXPECT_EQ(best.inlier_ratio, 1);
  for (const Pose2& other : {Pose2{{3, 30}, 0.1}, Pose2{{-1, 30}, 0.1}, Pose2{{1, 40}, 0.1},
                             Pose2{{1, 20}, 0.1}, Pose2{{1, 30}, 0.3}, Pose2{{1, 30}, 3.2}}) {
    EXPECT_LT(range_likelihood(other, 1, beams, walls, {}).log_likelihood, best.log_likelihood - 2)
        << other.enu_m.transpose() << " " << other.heading_rad;
  }
}

TEST(RangeLikelihood, RangesAreOdometryUntilScaled) {
  const RayCastingGrid walls(testing::bent_street());
  const Pose2 truth{{1, 30}, 0.1};
  std::vector<Beam> beams = beams_at(truth, walls);
  for (Beam& beam : beams) beam.range_m /= 1.2;
  EXPECT_NEAR(range_likelihood(truth, 1.2, beams, walls, {}).log_likelihood, 0, 1e-9);
  EXPECT_LT(range_likelihood(truth, 1, beams, walls, {}).log_likelihood, -2);
}

// A tree in front of a wall is less surprising than a point behind one.
TEST(RangeLikelihood, NearerIsLikelierThanFarther) {
  const RayCastingGrid walls({{{-20, 10}, {20, 10}, 0.1}});
  const Pose2 pose;
  const auto of_range = [&](double range_m) {
    const std::vector<Beam> beams = {{0, range_m, 0.2}};
    return range_likelihood(pose, 1, beams, walls, {}).log_likelihood;
  };
  EXPECT_NEAR(of_range(10), 0, 1e-9);
  EXPECT_GT(of_range(9.7), of_range(9));
  EXPECT_NEAR(of_range(4), std::log(RangeSettings{}.chance_nearer), 1e-6);
  EXPECT_NEAR(of_range(16), std::log(RangeSettings{}.chance_farther), 1e-6);
}

// A beam to an oblique wall: the uncertainties of the range, the heading, this wall and all walls
// add up, perpendicular to the wall.
TEST(RangeLikelihood, IsByAllThatIsNotKnown) {
  const RayCastingGrid walls({{{-30, -20}, {30, 40}, 0.8}});  // at 45 degrees, 10 m ahead
  RangeSettings settings;
  settings.sigma_m = 0.6;
  settings.heading_sigma_rad = 0.05;
  const double root2 = std::sqrt(2);
  const double variance_m2 =
      std::pow(0.9 / root2, 2) + std::pow(11.5 * 0.05 / root2, 2) + 0.8 * 0.8 + 0.6 * 0.6;
  const double off_m = 1.5 / root2;
  const double chance = settings.chance_farther;
  const std::vector<Beam> beams = {{0, 11.5, 0.9}};
  EXPECT_NEAR(range_likelihood({}, 1, beams, walls, settings).log_likelihood,
              std::log(chance + (1 - chance) * std::exp(-off_m * off_m / (2 * variance_m2))), 1e-9);
}

TEST(RangeLikelihood, BeamsWithinThreeSigmaAreExplained) {
  const RayCastingGrid walls({{{-20, 10}, {20, 10}, 0}});
  RangeSettings settings;
  settings.sigma_m = 1;
  const auto inlier_ratio = [&](double range_m) {
    const std::vector<Beam> beams = {{0, range_m, 0}};
    return range_likelihood({}, 1, beams, walls, settings).inlier_ratio;
  };
  EXPECT_EQ(inlier_ratio(10 + 2.9), 1);
  EXPECT_EQ(inlier_ratio(10 - 2.9), 1);
  EXPECT_EQ(inlier_ratio(10 + 3.1), 0);
  EXPECT_EQ(inlier_ratio(10 - 3.1), 0);
  settings.reach_m = 9;  // no wall within reach
  EXPECT_EQ(inlier_ratio(10), 0);
}

TEST(RangeLikelihood, ABeamThatMeetsNothingIsUnexplained) {
  const RayCastingGrid walls({{{-20, 10}, {20, 10}, 0.1}});
  const std::vector<Beam> beams = {{3.14, 10, 0.2}, {0, 10, 0.2}};
  const RangeLikelihood likelihood = range_likelihood({}, 1, beams, walls, {});
  EXPECT_DOUBLE_EQ(likelihood.inlier_ratio, 0.5);
  EXPECT_NEAR(likelihood.log_likelihood, std::log(RangeSettings{}.chance_nearer), 1e-6);
}

// A nearly grazing ray hits a wall far away or near depending on small errors: it is not penalized
// for that.
TEST(RangeLikelihood, AGrazingBeamIsMeasuredAcrossTheWall) {
  const RayCastingGrid walls({{{-200, 1}, {200, 1}, 0.1}});
  const double bearing = 1.5707963 - 0.05;
  const double range_m = 1 / std::cos(bearing);
  const std::vector<Beam> beams = {{bearing, range_m + 4, 0.2}};
  EXPECT_GT(range_likelihood({}, 1, beams, walls, {}).log_likelihood, -0.1);
}

TEST(RangeLikelihood, WithoutBeamsAllPosesAreAlike) {
  const RayCastingGrid walls({{{-20, 10}, {20, 10}, 0.1}});
  EXPECT_EQ(range_likelihood({}, 1, {}, walls, {}).log_likelihood, 0);
  EXPECT_EQ(range_likelihood({}, 1, {}, walls, {}).inlier_ratio, 0);
}

}  // namespace
}  // namespace milepost
