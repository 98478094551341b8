#include "client/global/evidence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/client/global/plan_rooms.h"

namespace milepost {
namespace {

// Ahead of a camera that looks north, a wall 10 m away, from west to east.
class EvidenceTest : public ::testing::Test {
 protected:
  double evidence(const PlanPose& pose, double wheel_scale = 1) const {
    return evidence_per_m(pose, wheel_scale, observation_, walls_, settings_);
  }

  WallIndex walls_{{{{-30, 10}, {30, 10}, 0.1}}};
  PlanPose pose_{{0, 0}, 0};
  WallObservation observation_{{{{-0.2, 0.2}, {std::numbers::pi / 2}}},
                               {{0.1, 10 / std::cos(0.1), 0.1}}};
  EvidenceSettings settings_;
};

TEST_F(EvidenceTest, NothingSeenSaysNothing) {
  observation_ = {};
  EXPECT_EQ(evidence(pose_), 0);
}

TEST_F(EvidenceTest, RangesAreScaled) {
  EXPECT_LT(evidence(pose_, 1.3), evidence(pose_) - 0.02);
  EXPECT_NEAR(evidence({{0, -2}, 0}, 1.2), evidence(pose_), 1e-3);
}

TEST_F(EvidenceTest, BothWaysOfSeeingCount) {
  const double of_both = evidence(pose_);
  const double nearer = evidence({{0, 4}, 0});  // the wall is turned rightly, but too near
  EXPECT_LT(nearer, of_both - 0.02);
  const WallObservation whole = observation_;
  observation_.sections.front().orientations_rad = {0.8};  // ... and here the other way round
  EXPECT_LT(evidence(pose_), of_both - 0.5);
  observation_ = whole;
  observation_.sections.clear();
  EXPECT_NEAR(evidence(pose_), 0, 1e-3);
  EXPECT_LT(evidence({{0, 4}, 0}), -0.02);
}

// Among trees every pose explains as little: none is to blame beyond some point.
TEST_F(EvidenceTest, AFrameThatShowsNoWallsIsNoProofAgainstAPose) {
  observation_.sections.clear();
  observation_.beams.assign(20, {0.1, 2, 0.1});
  EXPECT_NEAR(evidence(pose_), settings_.per_beam * settings_.least_per_beam * 20, 1e-9);
}

// However wrong the orientations are, they rule no pose out.
TEST_F(EvidenceTest, OrientationsCountAsFarAsSettingsSay) {
  const PlanPose away{{0, 0}, std::numbers::pi};
  observation_.beams.clear();
  EXPECT_TRUE(std::isfinite(evidence(away)));
  EXPECT_LT(evidence(away), evidence(pose_));
  const double near = evidence(pose_);
  settings_.view_reach_m = 5;  // the wall is not seen
  EXPECT_LT(evidence(pose_), near);
  settings_.view_reach_m = 60;
  settings_.orientations = 0;
  EXPECT_EQ(evidence(pose_), evidence(away));
}

TEST_F(EvidenceTest, WhereRangesMayErrMoreABeamTellsLess) {
  observation_.sections.clear();
  observation_.beams.front().range_m = 8.5;
  const double sharp = evidence(pose_);
  settings_.ranges.sigma_m *= 4;
  EXPECT_GT(evidence(pose_), sharp + 1e-3);
}

TEST_F(EvidenceTest, GrowsWithTheBeams) {
  observation_.sections.clear();
  observation_.beams.front().range_m = 8.5;
  const double of_one = evidence(pose_);
  observation_.beams.assign(3, observation_.beams.front());
  EXPECT_NEAR(evidence(pose_), 3 * of_one, 1e-9);
}

TEST_F(EvidenceTest, ACloudIsWeighedByTheWayOverWhichItIsSeen) {
  const ParticleCloud even = {{pose_, 0.5}, {{{0, 4}, 0}, 0.5}, {{{0, -2}, 0}, 0.5, 1.2}};
  ParticleCloud cloud = even;
  weigh_by_evidence(cloud, observation_, 3, walls_, settings_);
  EXPECT_NEAR(std::log(cloud[0].weight / cloud[1].weight),
              3 * (evidence(pose_) - evidence({{0, 4}, 0})), 1e-9);
  EXPECT_NEAR(std::log(cloud[0].weight / cloud[2].weight),
              3 * (evidence(pose_) - evidence({{0, -2}, 0}, 1.2)), 1e-9);
  EXPECT_NEAR(cloud[0].weight + cloud[1].weight + cloud[2].weight, 1, 1e-12);
}

TEST_F(EvidenceTest, WithoutBeamsACloudIsNotWeighed) {
  observation_.beams.clear();
  observation_.sections.front().orientations_rad = {0.8};
  ParticleCloud cloud = {{pose_, 0.5}, {{{0, 0}, 1}, 0.5}};
  weigh_by_evidence(cloud, observation_, 3, walls_, settings_);
  EXPECT_EQ(cloud[0].weight, 0.5);
}

}  // namespace
}  // namespace milepost
