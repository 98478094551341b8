#include "client/localize/place_odds.h"

#include <gtest/gtest.h>

#include <cmath>

namespace milepost {
namespace {

constexpr PlaceOddsSettings kSettings;

PlaceOdds seen_once(double log_bayes_factor) {
  PlaceOdds odds(kSettings);
  odds.add_frame(log_bayes_factor, log_bayes_factor, 0);
  return odds;
}

TEST(PlaceOdds, OneFrameIsNeverEnoughToClaim) {
  EXPECT_LT(seen_once(1000).log(), kSettings.claim);
  EXPECT_DOUBLE_EQ(seen_once(1000).log(), kSettings.first + kSettings.max_for);
}

TEST(PlaceOdds, AFrameThatSaysNothingChangesNothing) {
  EXPECT_DOUBLE_EQ(seen_once(0).log(), kSettings.first);
}

// The vehicle stands: the same landmarks are no new witnesses.
TEST(PlaceOdds, TheSameViewCountsOnce) {
  PlaceOdds odds = seen_once(3);
  const double once = odds.log();
  for (int frame = 0; frame < 100; ++frame) odds.add_frame(3, 3, 0);
  EXPECT_DOUBLE_EQ(odds.log(), once);
}

TEST(PlaceOdds, NewViewsCountAsFarAsTheyAreNew) {
  PlaceOdds odds = seen_once(3);
  const double once = odds.log();
  odds.add_frame(3, 3, kSettings.novel_m / 4);
  EXPECT_DOUBLE_EQ(odds.log(), once + 3.0 / 4);
  odds.add_frame(3, 3, 5 * kSettings.novel_m);
  EXPECT_DOUBLE_EQ(odds.log(), once + 3.0 / 4 + 3);
}

TEST(PlaceOdds, WhatSpeaksAgainstCountsWhereverItIsSeen) {
  PlaceOdds odds = seen_once(6);
  const double once = odds.log();
  odds.add_frame(-2, 0, 0);
  EXPECT_DOUBLE_EQ(odds.log(), once - 2);
  odds.add_frame(-50, 0, 0);  // may be a truck
  EXPECT_DOUBLE_EQ(odds.log(), once - 2 - kSettings.max_against);
}

// A facade that repeats: both places agree with what is seen, one of them better.
TEST(PlaceOdds, AFrameSpeaksForTheBetterOfTwoPlaces) {
  PlaceOdds odds(kSettings);
  odds.add_frame(20, 60, 0);
  EXPECT_DOUBLE_EQ(odds.log(), kSettings.first);
  odds.add_frame(20, 60, kSettings.novel_m / 10);
  EXPECT_DOUBLE_EQ(odds.log(), kSettings.first + 2 - 4);
}

TEST(PlaceOdds, EvidenceLapsesSoWhatIsLongCertainCanFall) {
  PlaceOdds odds(kSettings);
  for (int frame = 0; frame < 1000; ++frame) {
    odds.move(kSettings.novel_m);
    odds.add_frame(5, 5, frame * kSettings.novel_m);
  }
  EXPECT_LT(odds.log(), std::log(1 / kSettings.lapse) + kSettings.max_for);
  int frames = 0;
  while (odds.log() >= kSettings.give_up && frames < 100) {
    odds.move(kSettings.novel_m);
    odds.add_frame(-10, 0, 0);
    ++frames;
  }
  EXPECT_LE(frames, 4);
}

TEST(PlaceOdds, LapsingLeavesTheUnlikelyAlone) {
  PlaceOdds odds(kSettings);
  odds.move(kSettings.novel_m);
  EXPECT_NEAR(odds.log(), kSettings.first, 0.01);
}

// A red light changes nothing.
TEST(PlaceOdds, StandingNothingLapses) {
  PlaceOdds odds = seen_once(6);
  const double once = odds.log();
  for (int frame = 0; frame < 10000; ++frame) odds.move(0);
  EXPECT_DOUBLE_EQ(odds.log(), once);
}

}  // namespace
}  // namespace milepost
