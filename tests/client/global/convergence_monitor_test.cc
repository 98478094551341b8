#include "client/global/convergence_monitor.h"

#include <gtest/gtest.h>

#include <string>

namespace milepost {
namespace {

constexpr OdometryIncrement kStep{0.2, 2, 0};  // to the north

// A vehicle that drives north, monitored step by step.
class ConvergenceMonitorTest : public ::testing::Test {
 protected:
  GlobalStatus step(double mode_probability, std::optional<double> inlier_ratio) {
    north_m_ += kStep.distance_m;
    return monitor_.observe({{{jump_east_m_, north_m_}, 0}, mode_probability, 0.3, 0.01},
                            inlier_ratio, has_alternative_, kStep);
  }

  GlobalStatus steps(int count, double mode_probability, std::optional<double> inlier_ratio) {
    GlobalStatus status = GlobalStatus::initializing;
    for (int i = 0; i < count; ++i) status = step(mode_probability, inlier_ratio);
    return status;
  }

  // Steps until convergence of a vehicle that turns in its tenth step and whose mode is certain
  // after some steps.
  static int steps_until_found(double turn_rad, int uncertain_steps = 0) {
    ConvergenceMonitor monitor{ConvergenceSettings{}};
    Pose2 pose;
    int count = 0;
    while (!monitor.is_found() && count < 150) {
      const OdometryIncrement motion{0.2, 2, ++count == 10 ? turn_rad : 0};
      pose = moved(pose, motion.distance_m, motion.turn_rad);
      monitor.observe({pose, count > uncertain_steps ? 0.95 : 0.5, 0.3, 0.01}, 0.8, false, motion);
    }
    return count;
  }

  ConvergenceMonitor monitor_{ConvergenceSettings{}};
  double north_m_ = 0;
  double jump_east_m_ = 0;
  bool has_alternative_ = false;
};

TEST_F(ConvergenceMonitorTest, AModeThatExplainsMeasurementsForSomeDistanceIsFound) {
  EXPECT_EQ(steps(40, 0.95, 0.8), GlobalStatus::initializing);
  EXPECT_EQ(steps(12, 0.95, 0.8), GlobalStatus::tracking);
  EXPECT_TRUE(monitor_.is_found());
}

// Straight streets look alike; a bend distinguishes them.
TEST_F(ConvergenceMonitorTest, LessDistanceIsNeededWithABend) {
  EXPECT_LT(steps_until_found(1), 25);
  EXPECT_EQ(steps_until_found(-1), steps_until_found(1));
  EXPECT_GT(steps_until_found(0.5), 35);
  EXPECT_EQ(steps_until_found(0), steps_until_found(0.5));
}

// Belief after a bend was tested by the bend.
TEST_F(ConvergenceMonitorTest, ABendBeforeThePlaceHoldsTheBeliefCounts) {
  EXPECT_LT(steps_until_found(1, 15), 40);
  EXPECT_GT(steps_until_found(0, 15), 50);
  EXPECT_GT(steps_until_found(1, 60), 60 + 35) << "that bend is far behind";
}

TEST_F(ConvergenceMonitorTest, OneThatExplainsHalfIsNotFound) {
  EXPECT_EQ(steps(100, 0.95, 0.5), GlobalStatus::initializing);
}

// The whole distance for which a mode holds counts, not only its end.
TEST_F(ConvergenceMonitorTest, AStretchThatExplainsLittleIsMadeUpFor) {
  EXPECT_EQ(steps(35, 0.95, 0.9), GlobalStatus::initializing);
  EXPECT_EQ(steps(8, 0.95, 0.3), GlobalStatus::tracking);
}

TEST_F(ConvergenceMonitorTest, DistanceWithoutMeasurementsDoesNotCount) {
  steps(20, 0.95, 0.9);
  EXPECT_EQ(steps(100, 0.95, std::nullopt), GlobalStatus::initializing);
}

TEST_F(ConvergenceMonitorTest, AHalfOfTheBeliefIsNotEnough) {
  EXPECT_EQ(steps(100, 0.6, 0.8), GlobalStatus::initializing);
}

TEST_F(ConvergenceMonitorTest, AllOfTheBeliefIsNotEnoughWhereNothingIsExplained) {
  EXPECT_EQ(steps(100, 1, 0.2), GlobalStatus::initializing);
}

TEST_F(ConvergenceMonitorTest, WithAnAlternativeItIsNotFoundButStaysFound) {
  has_alternative_ = true;
  EXPECT_EQ(steps(100, 0.95, 0.8), GlobalStatus::initializing);
  has_alternative_ = false;
  EXPECT_EQ(step(0.95, 0.8), GlobalStatus::tracking);
  has_alternative_ = true;
  EXPECT_EQ(step(0.95, 0.8), GlobalStatus::tracking);
}

TEST_F(ConvergenceMonitorTest, APlaceThatJumpsIsAnotherOne) {
  for (int i = 0; i < 50; ++i) {
    jump_east_m_ = i % 2 == 0 ? 0 : 30;
    EXPECT_EQ(step(0.95, 0.8), GlobalStatus::initializing);
  }
}

TEST_F(ConvergenceMonitorTest, StandingStillFindsNothing) {
  for (int i = 0; i < 200; ++i) {
    EXPECT_EQ(monitor_.observe({{{0, 0}, 0}, 1, 0.3, 0.01}, 0.9, false, {0.2, 0, 0}),
              GlobalStatus::initializing);
  }
}

TEST_F(ConvergenceMonitorTest, FramesWithoutMeasurementsArePredicted) {
  steps(60, 0.95, 0.8);
  EXPECT_EQ(step(0.95, std::nullopt), GlobalStatus::predicted);
  EXPECT_EQ(step(0.95, 0.8), GlobalStatus::tracking);
}

TEST_F(ConvergenceMonitorTest, WhatWasFoundIsLostByAJumpAndFoundAgain) {
  steps(60, 0.95, 0.8);
  jump_east_m_ = 40;
  EXPECT_EQ(step(0.95, 0.8), GlobalStatus::lost);
  EXPECT_EQ(steps(30, 0.95, 0.8), GlobalStatus::lost);
  EXPECT_EQ(steps(15, 0.95, 0.8), GlobalStatus::tracking);
}

TEST_F(ConvergenceMonitorTest, LessIsNeededToStayThanToBeFound) {
  steps(60, 0.95, 0.8);
  EXPECT_EQ(steps(20, 0.6, 0.3), GlobalStatus::tracking);
  EXPECT_EQ(step(0.4, 0.3), GlobalStatus::lost);
  EXPECT_EQ(steps(20, 0.6, 0.8), GlobalStatus::lost);
}

TEST_F(ConvergenceMonitorTest, OneFrameThatIsNotExplainedLosesNothing) {
  steps(60, 0.95, 0.8);
  EXPECT_EQ(step(0.95, 0), GlobalStatus::tracking);
}

TEST_F(ConvergenceMonitorTest, WhatExplainsLessThanItUsedToIsDoubted) {
  steps(100, 0.95, 0.8);
  EXPECT_FALSE(monitor_.is_doubtful());
  steps(20, 0.95, 0.1);
  EXPECT_TRUE(monitor_.is_doubtful());
}

TEST_F(ConvergenceMonitorTest, WhatExplainsALittleLessThanItUsedToIsNotDoubted) {
  steps(600, 0.95, 0.8);
  steps(10, 0.95, 0.7);
  EXPECT_FALSE(monitor_.is_doubtful());
}

TEST_F(ConvergenceMonitorTest, DistanceCountsBackwardsAndInLongSteps) {
  const auto steps_until_found_by = [](double step_m) {
    ConvergenceMonitor monitor{ConvergenceSettings{}};
    Pose2 pose;
    int count = 0;
    for (; !monitor.is_found() && count < 200; ++count) {
      pose = moved(pose, step_m, 0);
      monitor.observe({pose, 0.95, 0.3, 0.01}, 0.8, false, {0.2, step_m, 0});
    }
    return count;
  };
  EXPECT_LT(steps_until_found_by(2), 200);
  EXPECT_EQ(steps_until_found_by(-2), steps_until_found_by(2));
  EXPECT_LT(steps_until_found_by(12), steps_until_found_by(2));
}

TEST(GlobalStatus, AreNamed) {
  EXPECT_STREQ(name_of(GlobalStatus::initializing), "initializing");
  EXPECT_STREQ(name_of(GlobalStatus::tracking), "tracking");
  EXPECT_STREQ(name_of(GlobalStatus::predicted), "predicted");
  EXPECT_STREQ(name_of(GlobalStatus::lost), "lost");
}

}  // namespace
}  // namespace milepost
