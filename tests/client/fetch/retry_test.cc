#include "client/fetch/retry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <vector>

namespace milepost::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

class RetryTest : public ::testing::Test {
 protected:
  RetryTest() {
    policy_.attempts = 4;
    policy_.first_pause_s = 1;
    policy_.longest_pause_s = 3;
    policy_.sleep = [this](double pause_s, const Stopped&) { pauses_s_.push_back(pause_s); };
  }

  static Attempt failed(ErrorCode code, double retry_after_s = 0) {
    return {Error{code, "where", "what", ""}, retry_after_s};
  }

  RetryPolicy policy_;
  std::vector<double> pauses_s_;
};

TEST_F(RetryTest, PausesGrowToALimitAndEnd) {
  int made = 0;
  const Status ended = with_retries(policy_, {}, [&] {
    ++made;
    return failed(ErrorCode::unavailable);
  });
  EXPECT_EQ(ended.error().code, ErrorCode::unavailable);
  EXPECT_EQ(made, 4);
  EXPECT_THAT(pauses_s_, ElementsAre(1, 2, 3));
}

TEST_F(RetryTest, TheServersPauseCountsIfItIsLonger) {
  std::vector<Attempt> attempts = {failed(ErrorCode::unavailable, 2.5),
                                   failed(ErrorCode::unavailable, 0.5), Attempt{}};
  std::size_t made = 0;
  EXPECT_TRUE(with_retries(policy_, {}, [&] { return attempts[made++]; }).ok());
  EXPECT_THAT(pauses_s_, ElementsAre(2.5, 2));
}

TEST_F(RetryTest, OtherErrorsAreFinal) {
  for (const ErrorCode code : {ErrorCode::not_found, ErrorCode::gone, ErrorCode::corrupt,
                               ErrorCode::invalid_input, ErrorCode::io}) {
    int made = 0;
    const Status ended = with_retries(policy_, {}, [&] {
      ++made;
      return failed(code);
    });
    EXPECT_EQ(ended.error().code, code);
    EXPECT_EQ(made, 1);
  }
  EXPECT_THAT(pauses_s_, IsEmpty());
}

TEST_F(RetryTest, WhatIsStoppedIsNotTriedAgain) {
  int made = 0;
  const Status ended = with_retries(
      policy_, [] { return true; },
      [&] {
        ++made;
        return failed(ErrorCode::unavailable);
      });
  EXPECT_EQ(ended.error().code, ErrorCode::unavailable);
  EXPECT_EQ(made, 1);
  EXPECT_TRUE(pauses_s_.empty());
}

TEST(Sleep, EndsWhenItIsStopped) {
  const auto began = std::chrono::steady_clock::now();
  int asked = 0;
  sleep_until_stopped(600, [&] { return ++asked > 2; });
  EXPECT_LT(std::chrono::steady_clock::now() - began, std::chrono::seconds(60));
  sleep_until_stopped(0.01, {});
}

}  // namespace
}  // namespace milepost::testing
