// Reads encoded tiles from the cache and, if it lacks them, from the server.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "client/cache/tile_cache.h"
#include "client/fetch/server_requests.h"
#include "client/fetch/tile_cutter.h"

namespace milepost {

// One request and the tiles that its response must consist of.
struct CheckedRequest {
  std::string url;
  std::vector<ExpectedTile> expected;
};

// Safe to use from several threads at once. Two threads that miss the same tile at the same time
// may both request it.
class TileFetcher {
 public:
  // Returns the request for some of the missing tiles; `missing` is never empty.
  using RequestFor = std::function<CheckedRequest(const std::set<std::uint32_t>& missing)>;

  // REQUIRES: both outlive the fetcher.
  TileFetcher(ServerRequests& requests, TileCache& cache) : requests_(requests), cache_(cache) {}

  // The wanted tiles by number. `layer_key` is their cache key except for the number. Complete
  // tiles of an interrupted response are kept and the rest is requested again. Errors: those of
  // HttpAnswer; corrupt (a response with other tiles than `request_for` expects).
  Result<std::map<std::uint32_t, Bytes>> fetch(const CacheKey& layer_key,
                                               const std::vector<ExpectedTile>& wanted,
                                               const RequestFor& request_for,
                                               const Stopped& stopped);

  // The same with a single request, from the server only. Each tile is passed to the sink as it
  // arrives, including tiles that are only part of the range. The sink returns whether the tile was
  // missing: an interrupted response that delivered a missing tile counts as success. A response
  // with wrong bytes is requested once more past caches.
  using TileSink = std::function<bool(std::uint32_t number, const Bytes& tile)>;
  Attempt fetch_once(const CacheKey& layer_key, const CheckedRequest& request, const TileSink& take,
                     const Stopped& stopped);
  // A tile from the cache; none if it is not there.
  std::optional<Bytes> find(const CacheKey& layer_key, const ExpectedTile& tile);

  std::uint64_t from_cache() const { return from_cache_; }
  std::uint64_t from_server() const { return from_server_; }

 private:
  Attempt fetch_from(Caches caches, const CacheKey& layer_key, const CheckedRequest& request,
                     const TileSink& take, const Stopped& stopped);

  ServerRequests& requests_;
  TileCache& cache_;
  std::atomic<std::uint64_t> from_cache_ = 0;
  std::atomic<std::uint64_t> from_server_ = 0;
};

}  // namespace milepost
