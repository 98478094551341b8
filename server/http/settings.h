// Limits on connections and requests.
#pragma once

#include <chrono>
#include <cstddef>

namespace milepost::server {

struct ConnectionLimits {
  // 0: as many as there are descriptors for (connections_within). More than that are never allowed.
  // At the limit the connection that has been idle for longest is closed in favour of a new one;
  // if none is idle, the new one is answered with 503.
  std::size_t connections = 0;
  std::size_t per_address = 0;                // of one client: then 503. 0: half of all
  std::size_t header_bytes = 16384;           // of a request, its first line included: 431 or 414
  std::size_t body_bytes = 16384;             // of a request; no route takes one: 413
  std::chrono::milliseconds idle{60'000};     // without a request on an open connection
  std::chrono::milliseconds request{10'000};  // from a request's first byte to its last: 408
  std::chrono::milliseconds stall{30'000};    // for a client to take the next 64 kB
  std::chrono::milliseconds lingering_close{2'000};  // for a client to close after a response
  std::chrono::milliseconds drain{5'000};            // for responses in progress at a stop
  std::chrono::milliseconds last_request{250};       // for one that is on its way at a stop
};

}  // namespace milepost::server
