// What an HTTP source is made of, so that tests can put in parts of their own.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "client/fetch/http_source.h"
#include "client/fetch/transport.h"

namespace milepost {

struct HttpSourceParts {
  std::unique_ptr<Transport> transport;
  std::function<void(double pause_s)> sleep;  // between two attempts
  std::function<std::int64_t()> now_s;        // seconds since 1970; called from any thread
};

// Errors: as open_http_source, which puts in libcurl, the thread's sleep and the system's clock.
Result<std::unique_ptr<MapSource>> make_http_source(const HttpSourceSettings& settings,
                                                    HttpSourceParts parts);

}  // namespace milepost
