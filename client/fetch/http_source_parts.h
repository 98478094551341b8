// The parts of an HTTP source, which tests replace by their own.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "client/cache/steady_clock.h"
#include "client/fetch/http_source.h"
#include "client/fetch/transport.h"

namespace milepost {

struct HttpSourceParts {
  std::unique_ptr<Transport> transport;
  // Pauses between two attempts.
  std::function<void(double pause_s, const Stopped& stopped)> sleep;
  // Seconds of a monotonic clock; called from any thread.
  std::function<std::int64_t()> steady_s = steady_seconds;
};

// Like open_http_source, which uses libcurl and sleeps the thread. Errors: the same.
Result<std::shared_ptr<MapSource>> make_http_source(const HttpSourceSettings& settings,
                                                    HttpSourceParts parts);

}  // namespace milepost
