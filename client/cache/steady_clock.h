// The monotonic clock for pauses; changes of the system time do not affect it.
#pragma once

#include <chrono>
#include <cstdint>

namespace milepost {

// Seconds since an arbitrary moment before the process started.
inline std::int64_t steady_seconds() {
  const auto since_then = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::seconds>(since_then).count();
}

}  // namespace milepost
