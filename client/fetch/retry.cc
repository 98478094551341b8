#include "client/fetch/retry.h"

#include <algorithm>
#include <chrono>
#include <thread>

namespace milepost {

Status with_retries(const RetryPolicy& policy, const Stopped& stopped,
                    const std::function<Attempt()>& attempt) {
  double pause_s = policy.first_pause_s;
  for (int made = 1;; ++made) {
    Attempt ended = attempt();
    const bool retriable =
        !ended.status.ok() && ended.status.error().code == ErrorCode::unavailable;
    if (!retriable || made >= policy.attempts || is_stopped(stopped))
      return std::move(ended.status);
    policy.sleep(std::min(std::max(pause_s, ended.retry_after_s), policy.longest_pause_s), stopped);
    pause_s *= 2;
  }
}

void sleep_until_stopped(double pause_s, const Stopped& stopped) {
  using std::chrono::duration;
  using std::chrono::steady_clock;
  constexpr duration<double> kLongest(0.05);
  const auto end = steady_clock::now() + duration<double>(pause_s);
  while (!is_stopped(stopped) && steady_clock::now() < end) {
    std::this_thread::sleep_for(std::min(kLongest, duration<double>(end - steady_clock::now())));
  }
}

}  // namespace milepost
