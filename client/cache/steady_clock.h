// The clock by which pauses are measured: it goes on whatever is done to the time of day.
#pragma once

#include <chrono>
#include <cstdint>

namespace milepost {

// Seconds since some moment before the process began.
inline std::int64_t steady_seconds() {
  const auto since_then = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::seconds>(since_then).count();
}

}  // namespace milepost
