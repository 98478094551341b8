// A tile server as a source, with a cache on disk in between.
#pragma once

#include <filesystem>
#include <string>

#include "client/fetch/map_source.h"
#include "client/fetch/stopped.h"

namespace milepost {

struct HttpSourceSettings {
  std::string server_url;                 // http://HOST:PORT, with or without a trailing slash
  std::filesystem::path cache_directory;  // made if need be; may be shared by several processes
  std::uint64_t cache_limit_bytes = 1ULL << 30U;  // least recently used tiles go first
  double connect_timeout_s = 5;
  double stall_timeout_s = 10;     // no byte for so long ends a request
  double least_bytes_per_s = 200;  // nor less than that
  int attempts = 3;                // of one request, with a growing pause between them
  Stopped stopped = {};            // ends every call soon
};

// Does not need the server yet: with a filled cache a vehicle drives on without one.
// Errors: invalid_input (URL), io (cache directory).
Result<std::shared_ptr<MapSource>> open_http_source(const HttpSourceSettings& settings);

}  // namespace milepost
