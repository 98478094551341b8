#include "client/fetch/backoff.h"

#include <gtest/gtest.h>

namespace milepost {
namespace {

using std::chrono::duration;
using std::chrono::seconds;

double pause_s(const Backoff& backoff, SteadyTime failed) {
  return duration<double>(backoff.due() - failed).count();
}

TEST(Backoff, DoublesUpToTheLongest) {
  std::mt19937 random(1);
  const BackoffSettings settings = {.first_s = 1, .longest_s = 10, .jitter = 0};
  const SteadyTime now{seconds(100)};
  Backoff backoff;
  EXPECT_TRUE(backoff.is_due(now));
  for (const double expected_s : {1.0, 2.0, 4.0, 8.0, 10.0, 10.0}) {
    backoff.failed(now, 0, settings, random);
    EXPECT_NEAR(pause_s(backoff, now), expected_s, 1e-6);
  }
  EXPECT_FALSE(backoff.is_due(now + seconds(9)));
  EXPECT_TRUE(backoff.is_due(now + seconds(11)));
  backoff.succeeded();
  EXPECT_EQ(backoff.failures(), 0);
  EXPECT_TRUE(backoff.is_due(now));
}

TEST(Backoff, ABusyServerIsGivenTheTimeItAsksForWithinTheLongest) {
  std::mt19937 random(1);
  const BackoffSettings settings = {.first_s = 1, .longest_s = 10, .jitter = 0};
  const SteadyTime now{seconds(100)};
  Backoff backoff;
  backoff.failed(now, 5, settings, random);
  EXPECT_NEAR(pause_s(backoff, now), 5, 1e-6);
  backoff.failed(now, 3600, settings, random);
  EXPECT_NEAR(pause_s(backoff, now), 10, 1e-6);
}

// So that vehicles which lost the same server do not retry in step.
TEST(Backoff, NoTwoPausesAreAlike) {
  std::mt19937 random(1);
  const BackoffSettings settings = {.first_s = 8, .longest_s = 30, .jitter = 0.25};
  const SteadyTime now{seconds(100)};
  double least_s = 100;
  double most_s = 0;
  for (int i = 0; i < 200; ++i) {
    Backoff backoff;
    backoff.failed(now, 0, settings, random);
    least_s = std::min(least_s, pause_s(backoff, now));
    most_s = std::max(most_s, pause_s(backoff, now));
  }
  EXPECT_GE(least_s, 6);
  EXPECT_LT(least_s, 6.5);
  EXPECT_LE(most_s, 10);
  EXPECT_GT(most_s, 9.5);
}

}  // namespace
}  // namespace milepost
