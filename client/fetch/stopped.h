// How long work is asked to end.
#pragma once

#include <functional>

#include "schema/base/result.h"

namespace milepost {

// Asked every now and then by what may take long, from any thread: true ends it soon, with
// `cancelled`. An empty one never does.
using Stopped = std::function<bool()>;

inline bool is_stopped(const Stopped& stopped) { return stopped && stopped(); }

inline Error cancelled(const std::string& where) {
  return {ErrorCode::cancelled, where, "stopped on request", ""};
}

}  // namespace milepost
