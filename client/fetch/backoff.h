// When to try again what failed: each time later, and not all vehicles at once.
#pragma once

#include <chrono>
#include <random>

namespace milepost {

using SteadyTime = std::chrono::steady_clock::time_point;

struct BackoffSettings {
  double first_s = 0.5;   // after the first failure; then twice as long each time
  double longest_s = 10;  // also where a server asks for more
  double jitter = 0.25;   // of the pause, to either side, at random
};

// Not safe to use from several threads at once.
class Backoff {
 public:
  // Failed at `now`; a busy server asked for `retry_after_s`.
  void failed(SteadyTime now, double retry_after_s, const BackoffSettings& settings,
              std::mt19937& random);
  void succeeded() { *this = {}; }

  int failures() const { return failures_; }  // in turn
  bool is_due(SteadyTime now) const { return now >= due_; }
  SteadyTime due() const { return due_; }

 private:
  int failures_ = 0;
  SteadyTime due_{};
};

}  // namespace milepost
