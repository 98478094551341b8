#include "client/global/mode_watch.h"

#include <gtest/gtest.h>

#include <string>

namespace milepost {
namespace {

constexpr WheelMotion kStep{0.2, 2, 0};  // to the north

// A vehicle that goes north, watched step by step.
class ModeWatchTest : public ::testing::Test {
 protected:
  FindStatus step(double mass, std::optional<double> explained) {
    north_m_ += kStep.distance_m;
    return watch_.observe({{{jump_east_m_, north_m_}, 0}, mass, 0.3, 0.01}, explained, is_rivalled_,
                          kStep);
  }

  FindStatus steps(int count, double mass, std::optional<double> explained) {
    FindStatus status = FindStatus::initializing;
    for (int i = 0; i < count; ++i) status = step(mass, explained);
    return status;
  }

  // Of one that turns in its tenth step, and whose place holds the belief after some steps.
  static int steps_until_found(double turn_rad, int uncertain_steps = 0) {
    ModeWatch watch{WatchSettings{}};
    PlanPose pose;
    int count = 0;
    while (!watch.is_found() && count < 150) {
      const WheelMotion motion{0.2, 2, ++count == 10 ? turn_rad : 0};
      pose = moved(pose, motion.distance_m, motion.turn_rad);
      watch.observe({pose, count > uncertain_steps ? 0.95 : 0.5, 0.3, 0.01}, 0.8, false, motion);
    }
    return count;
  }

  ModeWatch watch_{WatchSettings{}};
  double north_m_ = 0;
  double jump_east_m_ = 0;
  bool is_rivalled_ = false;
};

TEST_F(ModeWatchTest, OnePlaceThatExplainsWhatIsSeenForSomeWayIsFound) {
  EXPECT_EQ(steps(40, 0.95, 0.8), FindStatus::initializing);
  EXPECT_EQ(steps(12, 0.95, 0.8), FindStatus::tracking);
  EXPECT_TRUE(watch_.is_found());
}

// One straight street looks like another; a bend tells them apart.
TEST_F(ModeWatchTest, LessWayIsNeededRoundABend) {
  EXPECT_LT(steps_until_found(1), 25);
  EXPECT_EQ(steps_until_found(-1), steps_until_found(1));
  EXPECT_GT(steps_until_found(0.5), 35);
  EXPECT_EQ(steps_until_found(0), steps_until_found(0.5));
}

// What holds the belief after a bend was weighed on the way through it.
TEST_F(ModeWatchTest, ABendBeforeThePlaceHoldsTheBeliefCounts) {
  EXPECT_LT(steps_until_found(1, 15), 40);
  EXPECT_GT(steps_until_found(0, 15), 50);
  EXPECT_GT(steps_until_found(1, 60), 60 + 35) << "that bend is far behind";
}

TEST_F(ModeWatchTest, OneThatExplainsHalfIsNotFound) {
  EXPECT_EQ(steps(100, 0.95, 0.5), FindStatus::initializing);
}

// All of the way while a place holds counts, not only the last of it.
TEST_F(ModeWatchTest, AStretchThatExplainsLittleIsMadeUpFor) {
  EXPECT_EQ(steps(35, 0.95, 0.9), FindStatus::initializing);
  EXPECT_EQ(steps(8, 0.95, 0.3), FindStatus::tracking);
}

TEST_F(ModeWatchTest, WayThatShowsNothingFindsNothing) {
  steps(20, 0.95, 0.9);
  EXPECT_EQ(steps(100, 0.95, std::nullopt), FindStatus::initializing);
}

TEST_F(ModeWatchTest, AHalfOfTheBeliefIsNotEnough) {
  EXPECT_EQ(steps(100, 0.6, 0.8), FindStatus::initializing);
}

TEST_F(ModeWatchTest, AllOfTheBeliefIsNotEnoughWhereNothingIsExplained) {
  EXPECT_EQ(steps(100, 1, 0.2), FindStatus::initializing);
}

TEST_F(ModeWatchTest, OneWithARivalIsNotFoundButStaysFound) {
  is_rivalled_ = true;
  EXPECT_EQ(steps(100, 0.95, 0.8), FindStatus::initializing);
  is_rivalled_ = false;
  EXPECT_EQ(step(0.95, 0.8), FindStatus::tracking);
  is_rivalled_ = true;
  EXPECT_EQ(step(0.95, 0.8), FindStatus::tracking);
}

TEST_F(ModeWatchTest, APlaceThatJumpsIsAnotherOne) {
  for (int i = 0; i < 50; ++i) {
    jump_east_m_ = i % 2 == 0 ? 0 : 30;
    EXPECT_EQ(step(0.95, 0.8), FindStatus::initializing);
  }
}

TEST_F(ModeWatchTest, StandingStillFindsNothing) {
  for (int i = 0; i < 200; ++i) {
    EXPECT_EQ(watch_.observe({{{0, 0}, 0}, 1, 0.3, 0.01}, 0.9, false, {0.2, 0, 0}),
              FindStatus::initializing);
  }
}

TEST_F(ModeWatchTest, FramesThatTellNothingArePredicted) {
  steps(60, 0.95, 0.8);
  EXPECT_EQ(step(0.95, std::nullopt), FindStatus::predicted);
  EXPECT_EQ(step(0.95, 0.8), FindStatus::tracking);
}

TEST_F(ModeWatchTest, WhatWasFoundIsLostByAJumpAndFoundAgain) {
  steps(60, 0.95, 0.8);
  jump_east_m_ = 40;
  EXPECT_EQ(step(0.95, 0.8), FindStatus::lost);
  EXPECT_EQ(steps(30, 0.95, 0.8), FindStatus::lost);
  EXPECT_EQ(steps(15, 0.95, 0.8), FindStatus::tracking);
}

TEST_F(ModeWatchTest, LessIsNeededToStayThanToBeFound) {
  steps(60, 0.95, 0.8);
  EXPECT_EQ(steps(20, 0.6, 0.3), FindStatus::tracking);
  EXPECT_EQ(step(0.4, 0.3), FindStatus::lost);
  EXPECT_EQ(steps(20, 0.6, 0.8), FindStatus::lost);
}

TEST_F(ModeWatchTest, OneFrameThatIsNotExplainedLosesNothing) {
  steps(60, 0.95, 0.8);
  EXPECT_EQ(step(0.95, 0), FindStatus::tracking);
}

TEST_F(ModeWatchTest, WhatExplainsLessThanItUsedToIsDoubted) {
  steps(100, 0.95, 0.8);
  EXPECT_FALSE(watch_.is_doubtful());
  steps(20, 0.95, 0.1);
  EXPECT_TRUE(watch_.is_doubtful());
}

TEST_F(ModeWatchTest, WhatExplainsALittleLessThanItUsedToIsNotDoubted) {
  steps(600, 0.95, 0.8);
  steps(10, 0.95, 0.7);
  EXPECT_FALSE(watch_.is_doubtful());
}

TEST_F(ModeWatchTest, WayIsWayBackwardsAndInLongSteps) {
  const auto steps_until_found_by = [](double step_m) {
    ModeWatch watch{WatchSettings{}};
    PlanPose pose;
    int count = 0;
    for (; !watch.is_found() && count < 200; ++count) {
      pose = moved(pose, step_m, 0);
      watch.observe({pose, 0.95, 0.3, 0.01}, 0.8, false, {0.2, step_m, 0});
    }
    return count;
  };
  EXPECT_LT(steps_until_found_by(2), 200);
  EXPECT_EQ(steps_until_found_by(-2), steps_until_found_by(2));
  EXPECT_LT(steps_until_found_by(12), steps_until_found_by(2));
}

TEST(FindStatus, AreNamed) {
  EXPECT_STREQ(name_of(FindStatus::initializing), "initializing");
  EXPECT_STREQ(name_of(FindStatus::tracking), "tracking");
  EXPECT_STREQ(name_of(FindStatus::predicted), "predicted");
  EXPECT_STREQ(name_of(FindStatus::lost), "lost");
}

}  // namespace
}  // namespace milepost
