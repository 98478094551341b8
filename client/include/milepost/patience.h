// Time limit and cancellation of blocking calls.
#pragma once

#include <chrono>
#include <functional>

namespace milepost::vehicle {

struct Patience {
  // Counted from the start of the call, which then ends with `timed_out`.
  std::chrono::milliseconds longest = std::chrono::seconds(30);
  // Polled from any thread: once it returns true, the call ends with `cancelled` within 0.1 s. May
  // be empty.
  std::function<bool()> cancelled = {};
};

}  // namespace milepost::vehicle
