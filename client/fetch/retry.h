// Trying again what may succeed later.
#pragma once

#include <functional>

#include "client/fetch/stopped.h"
#include "schema/base/result.h"

namespace milepost {

struct RetryPolicy {
  int attempts = 3;             // >= 1, the first one included
  double first_pause_s = 0.25;  // then twice as long each time
  double longest_pause_s = 10;  // also where a server asks for more
  std::function<void(double pause_s, const Stopped& stopped)> sleep;
};

// How one attempt ended.
struct Attempt {
  Status status;
  double retry_after_s = 0;  // the pause that a busy server asked for; 0 if it asked for none
};

// Runs `attempt` until it ends otherwise than with `unavailable`, or the attempts are used up, or
// it is stopped, and returns how the last one ended.
Status with_retries(const RetryPolicy& policy, const Stopped& stopped,
                    const std::function<Attempt()>& attempt);

// Pauses the thread, but no longer than until `stopped` says so.
void sleep_until_stopped(double pause_s, const Stopped& stopped);

}  // namespace milepost
