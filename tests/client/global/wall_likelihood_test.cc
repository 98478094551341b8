#include "client/global/wall_likelihood.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/client/global/plan_rooms.h"

namespace milepost {
namespace {

// A wall 10 m ahead of a camera that looks north, from west to east.
class WallLikelihoodTest : public ::testing::Test {
 protected:
  double likelihood(const Pose2& pose, double odometry_scale = 1) const {
    return log_likelihood_per_m(pose, odometry_scale, observation_, walls_, settings_);
  }

  RayCastingGrid walls_{{{{-30, 10}, {30, 10}, 0.1}}};
  Pose2 pose_{{0, 0}, 0};
  WallObservation observation_{{{{-0.2, 0.2}, {std::numbers::pi / 2}}},
                               {{0.1, 10 / std::cos(0.1), 0.1}}};
  WallLikelihoodSettings settings_;
};

TEST_F(WallLikelihoodTest, WithoutMeasurementsItIsZero) {
  observation_ = {};
  EXPECT_EQ(likelihood(pose_), 0);
}

TEST_F(WallLikelihoodTest, RangesAreScaled) {
  EXPECT_LT(likelihood(pose_, 1.3), likelihood(pose_) - 0.02);
  EXPECT_NEAR(likelihood({{0, -2}, 0}, 1.2), likelihood(pose_), 1e-3);
}

TEST_F(WallLikelihoodTest, RangesAndOrientationsCount) {
  const double of_both = likelihood(pose_);
  const double nearer = likelihood({{0, 4}, 0});  // the orientation is right, but the wall too near
  EXPECT_LT(nearer, of_both - 0.02);
  const WallObservation whole = observation_;
  observation_.sections.front().orientations_rad = {0.8};  // ... and vice versa
  EXPECT_LT(likelihood(pose_), of_both - 0.5);
  observation_ = whole;
  observation_.sections.clear();
  EXPECT_NEAR(likelihood(pose_), 0, 1e-3);
  EXPECT_LT(likelihood({{0, 4}, 0}), -0.02);
}

// Among trees no pose explains the beams: the penalty is bounded.
TEST_F(WallLikelihoodTest, AFrameThatShowsNoWallsIsNoProofAgainstAPose) {
  observation_.sections.clear();
  observation_.beams.assign(20, {0.1, 2, 0.1});
  EXPECT_NEAR(likelihood(pose_), settings_.per_beam * settings_.least_per_beam * 20, 1e-9);
}

// Wrong orientations rule out no pose.
TEST_F(WallLikelihoodTest, OrientationsCountAsFarAsSettingsSay) {
  const Pose2 away{{0, 0}, std::numbers::pi};
  observation_.beams.clear();
  EXPECT_TRUE(std::isfinite(likelihood(away)));
  EXPECT_LT(likelihood(away), likelihood(pose_));
  const double near = likelihood(pose_);
  settings_.view_reach_m = 5;  // the wall is out of view
  EXPECT_LT(likelihood(pose_), near);
  settings_.view_reach_m = 60;
  settings_.orientations = 0;
  EXPECT_EQ(likelihood(pose_), likelihood(away));
}

TEST_F(WallLikelihoodTest, WithLessCertainRangesABeamCountsLess) {
  observation_.sections.clear();
  observation_.beams.front().range_m = 8.5;
  const double sharp = likelihood(pose_);
  settings_.ranges.sigma_m *= 4;
  EXPECT_GT(likelihood(pose_), sharp + 1e-3);
}

TEST_F(WallLikelihoodTest, GrowsWithTheBeams) {
  observation_.sections.clear();
  observation_.beams.front().range_m = 8.5;
  const double of_one = likelihood(pose_);
  observation_.beams.assign(3, observation_.beams.front());
  EXPECT_NEAR(likelihood(pose_), 3 * of_one, 1e-9);
}

TEST_F(WallLikelihoodTest, WeightsCountTheDistanceTravelled) {
  const ParticleSet even = {{pose_, 0.5}, {{{0, 4}, 0}, 0.5}, {{{0, -2}, 0}, 0.5, 1.2}};
  ParticleSet particles = even;
  measurement_update(particles, observation_, 3, walls_, settings_);
  EXPECT_NEAR(std::log(particles[0].weight / particles[1].weight),
              3 * (likelihood(pose_) - likelihood({{0, 4}, 0})), 1e-9);
  EXPECT_NEAR(std::log(particles[0].weight / particles[2].weight),
              3 * (likelihood(pose_) - likelihood({{0, -2}, 0}, 1.2)), 1e-9);
  EXPECT_NEAR(particles[0].weight + particles[1].weight + particles[2].weight, 1, 1e-12);
}

TEST_F(WallLikelihoodTest, WithoutBeamsWeightsStay) {
  observation_.beams.clear();
  observation_.sections.front().orientations_rad = {0.8};
  ParticleSet particles = {{pose_, 0.5}, {{{0, 0}, 1}, 0.5}};
  measurement_update(particles, observation_, 3, walls_, settings_);
  EXPECT_EQ(particles[0].weight, 0.5);
}

}  // namespace
}  // namespace milepost
