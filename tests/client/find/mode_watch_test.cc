#include "client/find/mode_watch.h"

#include <gtest/gtest.h>

#include <map>
#include <string>

namespace milepost {
namespace {

constexpr WheelMotion kStep{0.2, 2, 0};  // to the north

// A vehicle that goes north, watched step by step.
class ModeWatchTest : public ::testing::Test {
 protected:
  FindStatus step(double mass, std::optional<double> explained) {
    north_m_ += kStep.distance_m;
    return watch_.observe({{{jump_east_m_, north_m_}, 0}, mass, 0.3, 0.01}, explained, kStep);
  }

  FindStatus steps(int count, double mass, std::optional<double> explained) {
    FindStatus status = FindStatus::initializing;
    for (int i = 0; i < count; ++i) status = step(mass, explained);
    return status;
  }

  ModeWatch watch_{WatchSettings{}};
  double north_m_ = 0;
  double jump_east_m_ = 0;
};

TEST_F(ModeWatchTest, OnePlaceThatExplainsWhatIsSeenForSomeWayIsFound) {
  EXPECT_EQ(steps(40, 0.95, 0.8), FindStatus::initializing);
  EXPECT_EQ(steps(12, 0.95, 0.8), FindStatus::tracking);
  EXPECT_TRUE(watch_.is_found());
}

// How many steps of `step_m` a mode that goes with the wheels takes to be found, turning at some of
// the steps (counted from 1); it carries little of the belief up to the step `weak_until`.
int steps_until_found(const std::map<int, double>& turns_rad, double step_m = 2,
                      int weak_until = 0) {
  ModeWatch watch{WatchSettings{}};
  PlanPose pose;
  int count = 0;
  while (!watch.is_found() && count < 200) {
    ++count;
    const WheelMotion motion{0.2, step_m, turns_rad.contains(count) ? turns_rad.at(count) : 0};
    pose = moved(pose, motion.distance_m, motion.turn_rad);
    watch.observe({pose, count > weak_until ? 0.95 : 0.1, 0.3, 0.01}, 0.8, motion);
  }
  return count;
}

// One straight street looks like another; a bend tells them apart.
TEST(ModeWatch, LessWayIsNeededRoundABend) {
  const int straight = steps_until_found({});
  EXPECT_GT(straight, 45);
  EXPECT_LT(straight, 200);
  const int with_bend = steps_until_found({{15, 1}});
  EXPECT_LT(with_bend, 32);
  EXPECT_EQ(steps_until_found({{15, -1}}), with_bend);
  EXPECT_EQ(steps_until_found({{15, 0.5}}), straight);
  EXPECT_EQ(steps_until_found({{14, 0.5}, {15, 0.5}}), with_bend);
  EXPECT_EQ(steps_until_found({{12, 1}, {15, -1}}), with_bend);  // and back
}

TEST(ModeWatch, ABendBeforeThePlaceHeldTellsNothing) {
  const int straight = steps_until_found({}, 2, 20);
  EXPECT_GT(straight, 20 + 30);
  EXPECT_EQ(steps_until_found({{15, 1}}, 2, 20), straight);
  EXPECT_LT(steps_until_found({{25, 1}}, 2, 20), straight);
}

TEST(ModeWatch, WayIsWayBackwardsAndInLongSteps) {
  EXPECT_EQ(steps_until_found({}, -2), steps_until_found({}, 2));
  EXPECT_LT(steps_until_found({}, 12), steps_until_found({}, 2));
}

// What was found round a bend and lost takes as much to be found again as any.
TEST(ModeWatch, AfterAJumpABendIsForgotten) {
  const auto steps_after_a_jump = [](double turn_rad) {
    ModeWatch watch{WatchSettings{}};
    PlanPose pose;
    for (int i = 0; i < 60; ++i) {
      const WheelMotion motion{0.2, 2, i == 20 ? turn_rad : 0};
      pose = moved(pose, motion.distance_m, motion.turn_rad);
      watch.observe({pose, 0.95, 0.3, 0.01}, 0.8, motion);
    }
    EXPECT_TRUE(watch.is_found());
    pose.enu_m.x() += 100;
    int count = 0;
    do {
      pose = moved(pose, 2, 0);
      watch.observe({pose, 0.95, 0.3, 0.01}, 0.8, kStep);
      ++count;
    } while (!watch.is_found() && count < 200);
    return count;
  };
  EXPECT_EQ(steps_after_a_jump(1), steps_after_a_jump(0));
}

TEST_F(ModeWatchTest, AHalfOfTheBeliefIsNotEnough) {
  EXPECT_EQ(steps(100, 0.6, 0.8), FindStatus::initializing);
}

TEST_F(ModeWatchTest, AllOfTheBeliefIsNotEnoughWhereNothingIsExplained) {
  EXPECT_EQ(steps(100, 1, 0.2), FindStatus::initializing);
}

TEST_F(ModeWatchTest, APlaceThatJumpsIsAnotherOne) {
  for (int i = 0; i < 50; ++i) {
    jump_east_m_ = i % 2 == 0 ? 0 : 30;
    EXPECT_EQ(step(0.95, 0.8), FindStatus::initializing);
  }
}

TEST_F(ModeWatchTest, StandingStillFindsNothing) {
  for (int i = 0; i < 200; ++i) {
    EXPECT_EQ(watch_.observe({{{0, 0}, 0}, 1, 0.3, 0.01}, 0.9, {0.2, 0, 0}),
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
  EXPECT_EQ(steps(45, 0.95, 0.8), FindStatus::tracking);
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

TEST(FindStatus, AreNamed) {
  EXPECT_STREQ(name_of(FindStatus::initializing), "initializing");
  EXPECT_STREQ(name_of(FindStatus::tracking), "tracking");
  EXPECT_STREQ(name_of(FindStatus::predicted), "predicted");
  EXPECT_STREQ(name_of(FindStatus::lost), "lost");
}

}  // namespace
}  // namespace milepost
