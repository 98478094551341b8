// Where the map comes from.
#pragma once

#include <cstdint>
#include <string>
#include <variant>

namespace milepost::vehicle {

// A tile server, with a cache on disk in between: what was fetched once serves without a network.
struct ServerSource {
  std::string url;              // http(s)://HOST:PORT, perhaps with a path
  std::string cache_directory;  // made if need be; several processes may share it
  std::uint64_t cache_limit_bytes = 1'000'000'000;  // the least recently used tiles go first
  double connect_timeout_s = 5;
  // An answer that brings less than least_bytes_per_s over so long is given up and asked for again.
  double stall_timeout_s = 10;
  double least_bytes_per_s = 200;
};

// A map file: no server, no cache.
struct FileSource {
  std::string map_file;
};

using Source = std::variant<ServerSource, FileSource>;

}  // namespace milepost::vehicle
