#include "client/fetch/retry.h"

#include <algorithm>

namespace milepost {

Status with_retries(const RetryPolicy& policy, const std::function<Attempt()>& attempt) {
  double pause_s = policy.first_pause_s;
  for (int made = 1;; ++made) {
    Attempt ended = attempt();
    const bool retriable =
        !ended.status.ok() && ended.status.error().code == ErrorCode::unavailable;
    if (!retriable || made >= policy.attempts) return std::move(ended.status);
    policy.sleep(std::min(std::max(pause_s, ended.retry_after_s), policy.longest_pause_s));
    pause_s *= 2;
  }
}

}  // namespace milepost
