// The other places, in a street that looks the same from its two ends but for a house near one.
#include "client/global/contest.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>

namespace milepost {
namespace {

constexpr double kStepM = 2;
constexpr double kLengthM = 200;

// From south to north, 10 m to either side. The house juts out near the end.
std::vector<PlanWall> street_with_a_house() {
  return {{{-10, 0}, {-10, kLengthM}, 0.2}, {{10, 0}, {10, kLengthM}, 0.2},
          {{-10, 0}, {10, 0}, 0.2},         {{-10, kLengthM}, {10, kLengthM}, 0.2},
          {{10, 150}, {4, 150}, 0.2},       {{4, 150}, {4, 158}, 0.2},
          {{4, 158}, {10, 158}, 0.2}};
}

class ContestTest : public ::testing::Test {
 protected:
  // Both beams and orientations; exact.
  WallObservation seen_at(const PlanPose& pose) const {
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

  static PlanPose truth(const PlanPose& pose) { return pose; }

  static PlanPose forty_metres_back(const PlanPose& pose) { return moved(pose, -40, 0); }

  static PlanPose from_the_other_end(const PlanPose& pose) {
    return {{-pose.enu_m.x(), kLengthM - pose.enu_m.y()}, pose.heading_rad + std::numbers::pi};
  }

  static ParticleCloud belief_at(const PlanPose& pose) { return {100, {pose, 0.01}}; }

  // Drives to the north, all that time believing in a place that depends on the true one.
  void drive(int steps, PlanPose (*believed_at)(const PlanPose&), bool is_held = true) {
    for (int i = 0; i < steps; ++i) {
      truth_ = moved(truth_, kStepM, 0);
      const WheelMotion motion{0.2, kStepM, 0};
      const WallObservation observation = seen_at(truth_);
      contest_->move(motion, random_);
      const PlanPose believed = believed_at(truth_);
      if (history_.add(observation, motion) && is_held) {
        belief_ = belief_at(believed);
        contest_->hold(belief_, believed, observation, history_, random_);
      }
    }
  }

  // Part of the belief after the last contest that lies there.
  double believed_part(const PlanPose& pose) const {
    double part = 0;
    for (const Particle& particle : belief_) {
      const bool is_there = (particle.pose.enu_m - pose.enu_m).norm() < 5 &&
                            std::cos(particle.pose.heading_rad - pose.heading_rad) > 0.9;
      part += is_there ? particle.weight : 0;
    }
    return part;
  }

  WallIndex walls_{street_with_a_house()};
  PlanBox area_{{-10, 0}, {10, kLengthM}};
  Random random_{3};
  SightHistory history_{HistorySettings{}};
  std::optional<Contest> contest_{std::in_place, walls_, area_, 60, 200};
  PlanPose truth_{{2, 5}, 0};
  ParticleCloud belief_;
};

TEST_F(ContestTest, NothingLeadsBeforeItIsHeld) {
  EXPECT_EQ(contest_->lead(), 0);
  drive(10, truth, false);
  EXPECT_EQ(contest_->lead(), 0);
}

// From both ends the first half of the street is the same.
TEST_F(ContestTest, APlaceThatLooksTheSameIsARival) {
  drive(31, truth);
  EXPECT_LT(contest_->lead(), 4);
  EXPECT_GT(contest_->lead(), -2);
}

TEST_F(ContestTest, TheTruePlaceLeadsPastWhatTheOtherDoesNotHave) {
  drive(76, truth);
  EXPECT_GT(contest_->lead(), 4);
  EXPECT_GT(believed_part(truth_), 0.9);
}

TEST_F(ContestTest, AWrongPlaceLosesTheBelief) {
  drive(76, from_the_other_end);
  EXPECT_LT(contest_->lead(), -4);
  EXPECT_NEAR(believed_part(from_the_other_end(truth_)), 0.5, 0.05) << "half is earned at once";
  EXPECT_GT(believed_part(truth_), 0.2);
}

TEST_F(ContestTest, ARivalMayLookTheSameWay) {
  drive(76, forty_metres_back);
  EXPECT_LT(contest_->lead(), -7);
}

TEST_F(ContestTest, TheBeliefStaysWhole) {
  drive(40, from_the_other_end);
  for (const Particle& particle : belief_) EXPECT_GT(particle.weight, 0);
  double whole = 0;
  for (const Particle& particle : belief_) whole += particle.weight;
  EXPECT_NEAR(whole, 1, 1e-9);
}

// So few challengers hardly ever hit a place: it is kept.
TEST_F(ContestTest, RivalsAreKeptAndGoWithTheWheels) {
  for (int seed = 1; seed <= 5; ++seed) {
    random_.seed(static_cast<std::uint64_t>(seed));
    history_ = SightHistory(HistorySettings{});
    truth_ = {{2, 5}, 0};
    contest_.emplace(walls_, area_, 60, 20);
    drive(76, from_the_other_end);
    EXPECT_LT(contest_->lead(), -4) << "seed " << seed;
  }
}

}  // namespace
}  // namespace milepost
