#include "server/access/rate_limit.h"

#include <gtest/gtest.h>

#include <string>

namespace milepost::server {
namespace {

using namespace std::chrono_literals;

constexpr RateLimit::Clock::time_point kStart{1000s};

TEST(RateLimitTest, ABurstAndThenTheRate) {
  RateLimit limit({10, 5});
  for (int i = 0; i < 5; ++i) EXPECT_EQ(limit.wait("a", kStart), 0s) << i;
  EXPECT_EQ(limit.wait("a", kStart), 100ms);
  EXPECT_EQ(limit.wait("a", kStart + 99ms), 1ms);
  EXPECT_EQ(limit.wait("a", kStart + 100ms), 0s);
  EXPECT_GT(limit.wait("a", kStart + 100ms), 0s);
  // What is refused does not count.
  EXPECT_EQ(limit.wait("a", kStart + 200ms), 0s);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(limit.wait("a", kStart + 10s), 0s) << i;
  EXPECT_GT(limit.wait("a", kStart + 10s), 0s);
}

TEST(RateLimitTest, InTheLongRunTheRateIsWhatIsAllowed) {
  RateLimit limit({7, 3});
  int allowed = 0;
  for (auto now = kStart; now < kStart + 100s; now += 1ms) {
    if (limit.wait("a", now) == 0s) ++allowed;
  }
  EXPECT_NEAR(allowed, 700 + 3, 1);
}

TEST(RateLimitTest, ClientsHaveBucketsOfTheirOwn) {
  RateLimit limit({1, 1});
  EXPECT_EQ(limit.wait("a", kStart), 0s);
  EXPECT_EQ(limit.wait("b", kStart), 0s);
  EXPECT_GT(limit.wait("a", kStart), 0s);
}

TEST(RateLimitTest, ManyClientsShareWhatIsLeft) {
  RateLimit limit({0.001, 1});
  std::size_t allowed = 0;
  for (std::size_t i = 0; i < RateLimit::kClients + 10'000; ++i) {
    if (limit.wait(std::to_string(i), kStart) == 0s) ++allowed;
  }
  EXPECT_LE(allowed, RateLimit::kClients + 8);  // one more of each part of the memory
  EXPECT_GT(allowed, RateLimit::kClients / 2);
  EXPECT_GT(limit.wait("1", kStart), 0s);
  // Full buckets are forgotten, so that there is room again.
  EXPECT_EQ(limit.wait("new", kStart + 2000s), 0s);
  EXPECT_EQ(limit.wait("newer", kStart + 2000s), 0s);
}

TEST(RateLimitTest, WithoutALimitNobodyWaits) {
  RateLimit limit({});
  EXPECT_FALSE(limit.is_limited());
  for (int i = 0; i < 1000; ++i) EXPECT_EQ(limit.wait("a", kStart), 0s);
}

}  // namespace
}  // namespace milepost::server
