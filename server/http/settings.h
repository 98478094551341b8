// Settings of a server.
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "server/access/rate_limit.h"
#include "server/access/tokens.h"
#include "server/channel/tls_context.h"
#include "server/listen/listen_address.h"
#include "server/viewer/viewer.h"

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

struct ServerSettings {
  std::vector<ListenAddress> listen = {{}};  // by default any free port of 127.0.0.1
  std::vector<int> inherited = {};           // listening sockets, which the server takes over
  unsigned threads = 1;                      // >= 1, that send and receive
  unsigned disk_threads = 4;                 // >= 1, that read maps; as many readers are of use
  std::size_t disk_queue = 1024;             // requests that wait for these threads: then 503
  std::size_t hot_bytes = 64U << 20U;        // tiles and answers in memory
  ConnectionLimits limits = {};
  std::shared_ptr<const Viewer> viewer = nullptr;         // null: with a plain ground
  std::shared_ptr<const CurrentTls> tls = nullptr;        // null: plain HTTP on all addresses
  std::shared_ptr<const CurrentTokens> tokens = nullptr;  // null: everybody may ask for everything
  RateSettings rate = {};
  std::vector<std::string> allowed_origins = {};  // of pages that may read what is sent; "*": all
};

}  // namespace milepost::server
