#include "client/find/mode_watch.h"

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
  EXPECT_EQ(steps(15, 0.95, 0.8), FindStatus::initializing);
  EXPECT_EQ(steps(12, 0.95, 0.8), FindStatus::tracking);
  EXPECT_TRUE(watch_.is_found());
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
  steps(30, 0.95, 0.8);
  EXPECT_EQ(step(0.95, std::nullopt), FindStatus::predicted);
  EXPECT_EQ(step(0.95, 0.8), FindStatus::tracking);
}

TEST_F(ModeWatchTest, WhatWasFoundIsLostByAJumpAndFoundAgain) {
  steps(30, 0.95, 0.8);
  jump_east_m_ = 40;
  EXPECT_EQ(step(0.95, 0.8), FindStatus::lost);
  EXPECT_EQ(steps(20, 0.95, 0.8), FindStatus::tracking);
}

TEST_F(ModeWatchTest, LessIsNeededToStayThanToBeFound) {
  steps(30, 0.95, 0.8);
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
  EXPECT_EQ(watch_.doubt(), 0);
  steps(20, 0.95, 0.1);
  EXPECT_GT(watch_.doubt(), 0.2);
  EXPECT_LE(watch_.doubt(), 1);
}

TEST(FindStatus, AreNamed) {
  EXPECT_STREQ(name_of(FindStatus::initializing), "initializing");
  EXPECT_STREQ(name_of(FindStatus::tracking), "tracking");
  EXPECT_STREQ(name_of(FindStatus::predicted), "predicted");
  EXPECT_STREQ(name_of(FindStatus::lost), "lost");
}

}  // namespace
}  // namespace milepost
