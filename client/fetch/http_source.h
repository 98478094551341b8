// A map source that reads from a tile server through a cache on disk.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "client/fetch/map_source.h"
#include "client/fetch/stopped.h"
#include "schema/document/signing_key.h"

namespace milepost {

struct HttpSourceSettings {
  std::string server_url;                 // http://HOST:PORT, with or without a trailing slash
  std::filesystem::path cache_directory;  // created if missing; may be shared by several processes
  std::uint64_t cache_limit_bytes = 1ULL << 30U;  // least recently used tiles are evicted first
  double connect_timeout_s = 5;
  double stall_timeout_s = 10;     // a request slower than least_bytes_per_s for this time ...
  double least_bytes_per_s = 200;  // ... is aborted
  int attempts = 3;                // per request, with growing pauses between them
  Stopped stopped = {};            // cancels every call
  // If not empty, only builds that one of these keys has signed are used (PROTOCOL.md 3).
  std::vector<PublicKey> keys = {};
  std::string ca_file = {};  // as in TransportSettings
  std::string token = {};    // the same
};

// Does not contact the server yet: with a filled cache a vehicle drives without one. Errors:
// invalid_input (URL), io (cache directory).
Result<std::shared_ptr<MapSource>> open_http_source(const HttpSourceSettings& settings);

}  // namespace milepost
