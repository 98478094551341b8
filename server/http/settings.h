// Limits on connections and requests.
#pragma once

#include <chrono>
#include <cstddef>

namespace milepost::server {

struct ConnectionLimits {
  std::size_t connections = 1024;             // more are answered with 503 and closed
  std::size_t header_bytes = 16384;           // of a request, its first line included: 431 or 414
  std::size_t body_bytes = 16384;             // of a request; no route takes one: 413
  std::chrono::milliseconds idle{60'000};     // without a request on an open connection
  std::chrono::milliseconds request{10'000};  // from a request's first byte to its last
  std::chrono::milliseconds stall{30'000};    // for a client to take the next 64 kB
  std::chrono::milliseconds lingering_close{2'000};  // for a client to close after a response
  std::chrono::milliseconds drain{5'000};            // for responses in progress at a stop
};

}  // namespace milepost::server
