// Exponential backoff with jitter between retries, so that vehicles do not retry in step.
#pragma once

#include <chrono>
#include <random>

namespace milepost {

using SteadyTime = std::chrono::steady_clock::time_point;

struct BackoffSettings {
  double first_s = 0.5;   // after the first failure; doubled after each further one
  double longest_s = 10;  // upper bound, also of a server's Retry-After
  double jitter = 0.25;   // relative: the pause varies randomly by this part in either direction
};

// Not safe to use from several threads at once.
class Backoff {
 public:
  // Records a failure at `now`; `retry_after_s` is the pause that a busy server requested, or 0.
  void failed(SteadyTime now, double retry_after_s, const BackoffSettings& settings,
              std::mt19937& random);
  void succeeded() { *this = {}; }

  int failures() const { return failures_; }  // consecutive
  bool is_due(SteadyTime now) const { return now >= due_; }
  SteadyTime due() const { return due_; }

 private:
  int failures_ = 0;
  SteadyTime due_{};
};

}  // namespace milepost
