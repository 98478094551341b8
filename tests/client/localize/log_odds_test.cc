#include "client/localize/log_odds.h"

#include <gtest/gtest.h>

#include <cmath>

namespace milepost {
namespace {

constexpr LogOddsSettings kOddsSettings;

LogOdds seen_once(double log_bayes_factor) {
  LogOdds odds(kOddsSettings);
  odds.add_frame(log_bayes_factor, log_bayes_factor, 0);
  return odds;
}

TEST(LogOdds, OneFrameIsNeverEnoughToClaim) {
  EXPECT_LT(seen_once(1000).log(), kOddsSettings.claim);
  EXPECT_DOUBLE_EQ(seen_once(1000).log(), kOddsSettings.first + kOddsSettings.max_for);
}

TEST(LogOdds, AFrameThatSaysNothingChangesNothing) {
  EXPECT_DOUBLE_EQ(seen_once(0).log(), kOddsSettings.first);
}

// The vehicle stands: the same landmarks are not independent evidence.
TEST(LogOdds, TheSameViewCountsOnce) {
  LogOdds odds = seen_once(3);
  const double once = odds.log();
  for (int frame = 0; frame < 100; ++frame) odds.add_frame(3, 3, 0);
  EXPECT_DOUBLE_EQ(odds.log(), once);
}

// A pose that jumps to and fro about a facade while the vehicle is long elsewhere.
TEST(LogOdds, APoseThatJittersAboutOnePlaceSeesNothingNew) {
  LogOdds odds = seen_once(3);
  odds.add_frame(3, 3, kOddsSettings.novel_m / 4);
  const double once = odds.log();
  for (int frame = 0; frame < 100; ++frame)
    odds.add_frame(3, 3, frame % 2 == 0 ? 0 : kOddsSettings.novel_m / 4);
  EXPECT_DOUBLE_EQ(odds.log(), once);
  odds.add_frame(3, 3, -kOddsSettings.novel_m / 4);  // backwards
  EXPECT_DOUBLE_EQ(odds.log(), once + 3.0 / 4);
}

TEST(LogOdds, NewViewsCountAsFarAsTheyAreNew) {
  LogOdds odds = seen_once(3);
  const double once = odds.log();
  odds.add_frame(3, 3, kOddsSettings.novel_m / 4);
  EXPECT_DOUBLE_EQ(odds.log(), once + 3.0 / 4);
  odds.add_frame(3, 3, 5 * kOddsSettings.novel_m);
  EXPECT_DOUBLE_EQ(odds.log(), once + 3.0 / 4 + 3);
}

// Landmarks come into sight.
TEST(LogOdds, EvidenceThatGrowsCountsAsFarAsItIsMore) {
  LogOdds odds = seen_once(1);
  odds.add_frame(5, 5, 0);
  EXPECT_DOUBLE_EQ(odds.log(), seen_once(5).log());
  odds.add_frame(2, 2, 0);
  odds.add_frame(5, 5, 0);
  EXPECT_DOUBLE_EQ(odds.log(), seen_once(5).log());
  odds.add_frame(1000, 1000, 0);
  EXPECT_DOUBLE_EQ(odds.log(), seen_once(1000).log());  // one frame is never enough to claim
  odds.add_frame(5, 5, kOddsSettings.novel_m / 4);
  EXPECT_DOUBLE_EQ(odds.log(), seen_once(1000).log() + 5.0 / 4);
}

TEST(LogOdds, WhatSpeaksAgainstCountsWhereverItIsSeen) {
  LogOdds odds = seen_once(6);
  const double once = odds.log();
  odds.add_frame(-kOddsSettings.strongly_against, 0, 0);
  EXPECT_DOUBLE_EQ(odds.log(), once - kOddsSettings.strongly_against);
  odds.add_frame(-50, 0, 0);  // may be an occlusion
  EXPECT_DOUBLE_EQ(odds.log(), once - kOddsSettings.strongly_against - kOddsSettings.max_against);
}

TEST(LogOdds, WhatSpeaksWeaklyAgainstCountsInPartWhereTheViewIsNotNew) {
  LogOdds odds = seen_once(6);
  const double once = odds.log();
  odds.add_frame(-kOddsSettings.strongly_against / 3, 0, 0);
  EXPECT_DOUBLE_EQ(odds.log(), once - kOddsSettings.strongly_against / 9);
  odds.add_frame(-0.5, 0, kOddsSettings.novel_m);  // another view
  EXPECT_DOUBLE_EQ(odds.log(), once - kOddsSettings.strongly_against / 9 - 0.5);
}

// A repetitive facade: both hypotheses explain the frame, one of them better.
TEST(LogOdds, AFrameFavoursTheBetterOfTwoHypotheses) {
  LogOdds odds(kOddsSettings);
  odds.add_frame(20, 60, 0);
  EXPECT_DOUBLE_EQ(odds.log(), kOddsSettings.first);
  odds.add_frame(20, 60, kOddsSettings.novel_m / 10);
  EXPECT_DOUBLE_EQ(odds.log(), kOddsSettings.first + 2 - 4);
}

TEST(LogOdds, EvidenceLapsesSoWhatIsLongCertainCanFall) {
  LogOdds odds(kOddsSettings);
  for (int frame = 0; frame < 1000; ++frame) {
    odds.move(kOddsSettings.novel_m);
    odds.add_frame(5, 5, frame * kOddsSettings.novel_m);
  }
  EXPECT_LT(odds.log(), std::log(1 / kOddsSettings.lapse) + kOddsSettings.max_for);
  int frames = 0;
  while (odds.log() >= kOddsSettings.give_up && frames < 100) {
    odds.move(kOddsSettings.novel_m);
    odds.add_frame(-10, 0, 0);
    ++frames;
  }
  EXPECT_LE(frames, 4);
}

TEST(LogOdds, LapsingLeavesTheUnlikelyAlone) {
  LogOdds odds(kOddsSettings);
  odds.move(kOddsSettings.novel_m);
  EXPECT_NEAR(odds.log(), kOddsSettings.first, 0.01);
}

// A red light changes nothing.
TEST(LogOdds, StandingNothingLapses) {
  LogOdds odds = seen_once(6);
  const double once = odds.log();
  for (int frame = 0; frame < 10000; ++frame) odds.move(0);
  EXPECT_DOUBLE_EQ(odds.log(), once);
}

}  // namespace
}  // namespace milepost
