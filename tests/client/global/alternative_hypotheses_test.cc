// Alternative hypotheses in a street that looks the same from both ends except for a house near
// one.
#include "client/global/alternative_hypotheses.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>

namespace milepost {
namespace {

constexpr double kStepM = 2;
constexpr double kLengthM = 200;

// From south to north, 10 m to either side. The house protrudes near the end.
std::vector<PlanWall> street_with_a_house() {
  return {{{-10, 0}, {-10, kLengthM}, 0.2}, {{10, 0}, {10, kLengthM}, 0.2},
          {{-10, 0}, {10, 0}, 0.2},         {{-10, kLengthM}, {10, kLengthM}, 0.2},
          {{10, 150}, {4, 150}, 0.2},       {{4, 150}, {4, 158}, 0.2},
          {{4, 158}, {10, 158}, 0.2}};
}

class AlternativeHypothesesTest : public ::testing::Test {
 protected:
  // Exact beams and orientations.
  WallObservation seen_at(const Pose2& pose) const {
    WallObservation observation;
    for (double bearing = -0.7; bearing < 0.71; bearing += 0.07) {
      const auto hit = walls_.first_hit(pose.enu_m, direction_of(pose.heading_rad + bearing), 60);
      if (!hit) continue;
      observation.beams.push_back({bearing, hit->range_m, 0.2});
      observation.sections.push_back(
          {{bearing - 0.03, bearing + 0.03},
           {walls_.walls()[hit->wall].azimuth_rad() - pose.heading_rad}});
    }
    return observation;
  }

  static Pose2 truth(const Pose2& pose) { return pose; }

  static Pose2 forty_metres_back(const Pose2& pose) { return moved(pose, -40, 0); }

  static Pose2 from_the_other_end(const Pose2& pose) {
    return {{-pose.enu_m.x(), kLengthM - pose.enu_m.y()}, pose.heading_rad + std::numbers::pi};
  }

  static ParticleSet belief_at(const Pose2& pose) { return {100, {pose, 0.01}}; }

  // Drives to the north with a belief that depends on the true pose.
  void drive(int steps, Pose2 (*believed_at)(const Pose2&), bool is_held = true) {
    for (int i = 0; i < steps; ++i) {
      truth_ = moved(truth_, kStepM, 0);
      const OdometryIncrement motion{0.2, kStepM, 0};
      const WallObservation observation = seen_at(truth_);
      alternatives_->move(motion, random_);
      const Pose2 believed = believed_at(truth_);
      if (window_.add(observation, motion) && is_held) {
        belief_ = belief_at(believed);
        alternatives_->test(belief_, believed, observation, window_, random_);
      }
    }
  }

  // The part of the belief near a pose after the last test.
  double believed_part(const Pose2& pose) const {
    double part = 0;
    for (const Particle& particle : belief_) {
      const bool is_there = (particle.pose.enu_m - pose.enu_m).norm() < 5 &&
                            std::cos(particle.pose.heading_rad - pose.heading_rad) > 0.9;
      part += is_there ? particle.weight : 0;
    }
    return part;
  }

  RayCastingGrid walls_{street_with_a_house()};
  PlanBox area_{{-10, 0}, {10, kLengthM}};
  Random random_{3};
  MeasurementWindow window_{MeasurementWindowSettings{}};
  std::optional<AlternativeHypotheses> alternatives_{std::in_place, walls_, area_, 60, 200};
  Pose2 truth_{{2, 5}, 0};
  ParticleSet belief_;
};

TEST_F(AlternativeHypothesesTest, TheRatioIsZeroBeforeTheFirstTest) {
  EXPECT_EQ(alternatives_->log_likelihood_ratio(), 0);
  drive(10, truth, false);
  EXPECT_EQ(alternatives_->log_likelihood_ratio(), 0);
}

// From both ends the first half of the street is the same.
TEST_F(AlternativeHypothesesTest, APlaceThatLooksTheSameIsAnAlternative) {
  drive(31, truth);
  EXPECT_LT(alternatives_->log_likelihood_ratio(), 4);
  EXPECT_GT(alternatives_->log_likelihood_ratio(), -2);
}

TEST_F(AlternativeHypothesesTest, TheTruePoseWinsPastWhatTheOtherDoesNotHave) {
  drive(76, truth);
  EXPECT_GT(alternatives_->log_likelihood_ratio(), 4);
  EXPECT_GT(believed_part(truth_), 0.9);
}

TEST_F(AlternativeHypothesesTest, AWrongPlaceLosesTheBelief) {
  drive(76, from_the_other_end);
  EXPECT_LT(alternatives_->log_likelihood_ratio(), -4);
  EXPECT_NEAR(believed_part(from_the_other_end(truth_)), 0.5, 0.05) << "at most half at once";
  EXPECT_GT(believed_part(truth_), 0.2);
}

TEST_F(AlternativeHypothesesTest, AnAlternativeMayHaveTheSameHeading) {
  drive(76, forty_metres_back);
  EXPECT_LT(alternatives_->log_likelihood_ratio(), -7);
}

TEST_F(AlternativeHypothesesTest, TheBeliefStaysWhole) {
  drive(40, from_the_other_end);
  for (const Particle& particle : belief_) EXPECT_GT(particle.weight, 0);
  double whole = 0;
  for (const Particle& particle : belief_) whole += particle.weight;
  EXPECT_NEAR(whole, 1, 1e-9);
}

// With so few proposals the true pose is rarely drawn: it must be kept.
TEST_F(AlternativeHypothesesTest, AlternativesAreKeptAndMoveByOdometry) {
  for (int seed = 1; seed <= 5; ++seed) {
    random_.seed(static_cast<std::uint64_t>(seed));
    window_ = MeasurementWindow(MeasurementWindowSettings{});
    truth_ = {{2, 5}, 0};
    alternatives_.emplace(walls_, area_, 60, 20);
    drive(76, from_the_other_end);
    EXPECT_LT(alternatives_->log_likelihood_ratio(), -4) << "seed " << seed;
  }
}

}  // namespace
}  // namespace milepost
