// What an HTTP source is made of, so that tests can put in parts of their own.
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
  // Between two attempts.
  std::function<void(double pause_s, const Stopped& stopped)> sleep;
  // Seconds of a clock that nobody sets; called from any thread.
  std::function<std::int64_t()> steady_s = steady_seconds;
};

// Errors: as open_http_source, which puts in libcurl and the thread's sleep.
Result<std::shared_ptr<MapSource>> make_http_source(const HttpSourceSettings& settings,
                                                    HttpSourceParts parts);

}  // namespace milepost
