// Cancellation of long operations.
#pragma once

#include <functional>

#include "schema/base/result.h"

namespace milepost {

// Polled by long operations, from any thread: once it returns true, the operation ends soon with
// `cancelled`. An empty function never stops anything.
using Stopped = std::function<bool()>;

inline bool is_stopped(const Stopped& stopped) { return stopped && stopped(); }

inline Error cancelled(const std::string& where) {
  return {ErrorCode::cancelled, where, "stopped on request", ""};
}

}  // namespace milepost
