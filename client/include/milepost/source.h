// Where the map comes from: a tile server or a map file.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace milepost::vehicle {

// A tile server with a cache on disk: what was fetched once is available without a network.
struct ServerSource {
  std::string url;              // http(s)://HOST:PORT, optionally with a path
  std::string cache_directory;  // created if missing; several processes may share it
  std::uint64_t cache_limit_bytes = 1'000'000'000;  // least recently used tiles are evicted first
  double connect_timeout_s = 5;                     // above 0, at most 3600
  // A response with less than least_bytes_per_s over this time is aborted and requested again.
  double stall_timeout_s = 10;     // above 0, at most 3600
  double least_bytes_per_s = 200;  // above 0
  // Contents of the operator's KEY.pub files (milepost-server keygen). If there are any, only maps
  // that one of these keys has signed are used, from the server and from the cache.
  std::vector<std::string> public_keys = {};
  // A file of certificates in PEM form by which the server is trusted over https; empty: those of
  // the system.
  std::string ca_file = {};
  // The token that the operator gave out (milepost-server token), where the server asks for one.
  std::string token = {};
};

// A map file, read without a server or a cache.
struct FileSource {
  std::string map_file;
};

using Source = std::variant<ServerSource, FileSource>;

}  // namespace milepost::vehicle
