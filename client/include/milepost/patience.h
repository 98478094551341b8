// How long a call that may take time may take.
#pragma once

#include <chrono>
#include <functional>

namespace milepost::vehicle {

struct Patience {
  // From the call on. When it is over, the call ends with `timed_out`.
  std::chrono::milliseconds longest = std::chrono::seconds(30);
  // Asked now and then, from any thread: once it says true, the call ends with `cancelled` within a
  // tenth of a second. May be empty.
  std::function<bool()> cancelled = {};
};

}  // namespace milepost::vehicle
