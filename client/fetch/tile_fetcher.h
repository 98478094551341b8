// Encoded tiles from the cache and, where it lacks them, from the server.
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

// One request, and what its answer must consist of.
struct CheckedRequest {
  std::string url;
  std::vector<ExpectedTile> expected;
};

// Safe to use from several threads at once. Two that miss the same tile at the same time may both
// ask for it.
class TileFetcher {
 public:
  // The request that brings some of the missing tiles, which are never none.
  using RequestFor = std::function<CheckedRequest(const std::set<std::uint32_t>& missing)>;

  // Both outlive the fetcher.
  TileFetcher(ServerRequests& requests, TileCache& cache) : requests_(requests), cache_(cache) {}

  // The wanted tiles, by number. `layer_key` is theirs in the cache, but for the number. Whole
  // tiles of an answer that breaks off are kept, and the rest is asked for again.
  // Errors: those of HttpAnswer; corrupt (an answer of other tiles than `request_for` expects).
  Result<std::map<std::uint32_t, Bytes>> fetch(const CacheKey& layer_key,
                                               const std::vector<ExpectedTile>& wanted,
                                               const RequestFor& request_for,
                                               const Stopped& stopped);

  // The same of one request, from the server alone; each tile is handed over as it arrives, also
  // one that only comes along. The sink says whether it was missing: an answer that breaks off
  // after it brought one of those ends well.
  using TileSink = std::function<bool(std::uint32_t number, const Bytes& tile)>;
  Attempt fetch_once(const CacheKey& layer_key, const CheckedRequest& request, const TileSink& take,
                     const Stopped& stopped);
  // A tile of the cache; nothing where it is not there.
  std::optional<Bytes> find(const CacheKey& layer_key, const ExpectedTile& tile);

  std::uint64_t from_cache() const { return from_cache_; }
  std::uint64_t from_server() const { return from_server_; }

 private:
  ServerRequests& requests_;
  TileCache& cache_;
  std::atomic<std::uint64_t> from_cache_ = 0;
  std::atomic<std::uint64_t> from_server_ = 0;
};

}  // namespace milepost
