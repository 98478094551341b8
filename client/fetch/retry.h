// Retries of operations that may succeed later.
#pragma once

#include <functional>

#include "client/fetch/stopped.h"
#include "schema/base/result.h"

namespace milepost {

struct RetryPolicy {
  int attempts = 3;             // >= 1, including the first one
  double first_pause_s = 0.25;  // doubled after each attempt
  double longest_pause_s = 10;  // upper bound, also of a server's Retry-After
  std::function<void(double pause_s, const Stopped& stopped)> sleep;
};

// The outcome of one attempt.
struct Attempt {
  Status status;
  double retry_after_s = 0;  // the pause that a busy server requested; 0 if none
  bool is_foreign = false;   // something other than a milepost server answered
};

// Runs `attempt` until it returns something other than `unavailable`, the attempts are used up, or
// it is stopped. Returns the status of the last attempt.
Status with_retries(const RetryPolicy& policy, const Stopped& stopped,
                    const std::function<Attempt()>& attempt);

// Pauses the thread, at most until `stopped` returns true.
void sleep_until_stopped(double pause_s, const Stopped& stopped);

}  // namespace milepost
