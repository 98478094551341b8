#include "client/global/range_agreement.h"

#include <gtest/gtest.h>

#include <cmath>

#include <Eigen/Geometry>

#include "tests/client/global/plan_rooms.h"

namespace milepost {
namespace {

TEST(Beams, AreTheBestKnownPointsOfEachBearingOverTheCamerasHeight) {
  const std::vector<ScenePoint> points = {
      {{0, -2, 10}, 0.5},    // ahead
      {{0.1, -3, 10}, 0.2},  // ahead, better known
      {{0.2, -4, 12}, 0.9},  // ahead, too, and worse
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

// What a camera at `pose` sees of the walls, one beam each 3 degrees.
std::vector<Beam> beams_at(const PlanPose& pose, const WallIndex& walls) {
  std::vector<Beam> beams;
  for (double bearing = -0.7; bearing < 0.7; bearing += 0.05) {
    const auto hit = walls.first_hit(pose.enu_m, direction_of(pose.heading_rad + bearing), 60);
    if (hit) beams.push_back({bearing, hit->range_m, 0.2});
  }
  return beams;
}

TEST(RangeAgreement, IsBestWhereTheBeamsWereSeen) {
  const WallIndex walls(testing::bent_street());
  const PlanPose truth{{1, 30}, 0.1};
  const std::vector<Beam> beams = beams_at(truth, walls);
  ASSERT_GT(beams.size(), 20U);
  const RangeAgreement best = range_agreement(truth, 1, beams, walls, {});
  EXPECT_NEAR(best.log_likelihood, 0, 1e-9);
  EXPECT_EQ(best.explained, 1);
  for (const PlanPose& other :
       {PlanPose{{3, 30}, 0.1}, PlanPose{{-1, 30}, 0.1}, PlanPose{{1, 40}, 0.1},
        PlanPose{{1, 20}, 0.1}, PlanPose{{1, 30}, 0.3}, PlanPose{{1, 30}, 3.2}}) {
    EXPECT_LT(range_agreement(other, 1, beams, walls, {}).log_likelihood, best.log_likelihood - 2)
        << other.enu_m.transpose() << " " << other.heading_rad;
  }
}

TEST(RangeAgreement, MetresAreTheWheelsUntilScaled) {
  const WallIndex walls(testing::bent_street());
  const PlanPose truth{{1, 30}, 0.1};
  std::vector<Beam> beams = beams_at(truth, walls);
  for (Beam& beam : beams) beam.range_m /= 1.2;
  EXPECT_NEAR(range_agreement(truth, 1.2, beams, walls, {}).log_likelihood, 0, 1e-9);
  EXPECT_LT(range_agreement(truth, 1, beams, walls, {}).log_likelihood, -2);
}

// A tree before a wall is less of a surprise than a point behind one.
TEST(RangeAgreement, NearerIsLikelierThanFarther) {
  const WallIndex walls({{{-20, 10}, {20, 10}, 0.1}});
  const PlanPose pose;
  const auto of_range = [&](double range_m) {
    const std::vector<Beam> beams = {{0, range_m, 0.2}};
    return range_agreement(pose, 1, beams, walls, {}).log_likelihood;
  };
  EXPECT_NEAR(of_range(10), 0, 1e-9);
  EXPECT_GT(of_range(9.7), of_range(9));
  EXPECT_NEAR(of_range(4), std::log(RangeSettings{}.chance_nearer), 1e-6);
  EXPECT_NEAR(of_range(16), std::log(RangeSettings{}.chance_farther), 1e-6);
}

// A beam to a wall that stands askew: what is not known of the range, of the heading, of this wall
// and of all walls adds up, across the wall.
TEST(RangeAgreement, IsByAllThatIsNotKnown) {
  const WallIndex walls({{{-30, -20}, {30, 40}, 0.8}});  // at 45 degrees, 10 m ahead
  RangeSettings settings;
  settings.sigma_m = 0.6;
  settings.heading_sigma_rad = 0.05;
  const double root2 = std::sqrt(2);
  const double variance_m2 =
      std::pow(0.9 / root2, 2) + std::pow(11.5 * 0.05 / root2, 2) + 0.8 * 0.8 + 0.6 * 0.6;
  const double off_m = 1.5 / root2;
  const double chance = settings.chance_farther;
  const std::vector<Beam> beams = {{0, 11.5, 0.9}};
  EXPECT_NEAR(range_agreement({}, 1, beams, walls, settings).log_likelihood,
              std::log(chance + (1 - chance) * std::exp(-off_m * off_m / (2 * variance_m2))), 1e-9);
}

TEST(RangeAgreement, BeamsWithinThreeSigmaAreExplained) {
  const WallIndex walls({{{-20, 10}, {20, 10}, 0}});
  RangeSettings settings;
  settings.sigma_m = 1;
  const auto explained = [&](double range_m) {
    const std::vector<Beam> beams = {{0, range_m, 0}};
    return range_agreement({}, 1, beams, walls, settings).explained;
  };
  EXPECT_EQ(explained(10 + 2.9), 1);
  EXPECT_EQ(explained(10 - 2.9), 1);
  EXPECT_EQ(explained(10 + 3.1), 0);
  EXPECT_EQ(explained(10 - 3.1), 0);
  settings.reach_m = 9;  // no wall is looked at
  EXPECT_EQ(explained(10), 0);
}

TEST(RangeAgreement, ABeamThatMeetsNothingIsUnexplained) {
  const WallIndex walls({{{-20, 10}, {20, 10}, 0.1}});
  const std::vector<Beam> beams = {{3.14, 10, 0.2}, {0, 10, 0.2}};
  const RangeAgreement agreement = range_agreement({}, 1, beams, walls, {});
  EXPECT_DOUBLE_EQ(agreement.explained, 0.5);
  EXPECT_NEAR(agreement.log_likelihood, std::log(RangeSettings{}.chance_nearer), 1e-6);
}

// A ray that all but grazes a wall meets it far away or near by a hair: it is not held to that.
TEST(RangeAgreement, AGrazingBeamIsMeasuredAcrossTheWall) {
  const WallIndex walls({{{-200, 1}, {200, 1}, 0.1}});
  const double bearing = 1.5707963 - 0.05;
  const double range_m = 1 / std::cos(bearing);
  const std::vector<Beam> beams = {{bearing, range_m + 4, 0.2}};
  EXPECT_GT(range_agreement({}, 1, beams, walls, {}).log_likelihood, -0.1);
}

TEST(RangeAgreement, WithoutBeamsAllPosesAreAlike) {
  const WallIndex walls({{{-20, 10}, {20, 10}, 0.1}});
  EXPECT_EQ(range_agreement({}, 1, {}, walls, {}).log_likelihood, 0);
  EXPECT_EQ(range_agreement({}, 1, {}, walls, {}).explained, 0);
}

}  // namespace
}  // namespace milepost
