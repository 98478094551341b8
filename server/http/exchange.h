// One request and what became of it.
#pragma once

#include <chrono>
#include <cstdint>
#include <string_view>

#include "server/metrics/metrics.h"

namespace milepost::server {

struct Exchange {
  std::string_view peer;  // an address, or "unix"
  std::string_view method;
  std::string_view target;
  unsigned status = 0;
  std::uint64_t body_bytes = 0;     // as stated, also to HEAD
  std::chrono::nanoseconds took{};  // from the whole request to the last byte handed to the system
  bool aborted = false;             // not all of the response was sent
  std::string_view route = {};      // Response::route, of which this is
  std::string_view map = {};        // the same
  std::uint64_t tiles = 0;          // and cells in the body
  std::string_view token = {};      // the name of a valid one
};

// Every exchange comes here, on the thread of its connection: what counts or logs requests begins
// here. Logs one line at level info, and counts.
void observe(const Exchange& exchange, Metrics& metrics);

}  // namespace milepost::server
