#include "client/fetch/tile_fetcher.h"

#include <utility>

namespace milepost {
namespace {

std::uint64_t bytes_of(const std::vector<ExpectedTile>& tiles) {
  std::uint64_t bytes = 0;
  for (const ExpectedTile& tile : tiles) bytes += tile.bytes;
  return bytes;
}

CacheKey key_of(CacheKey layer_key, std::uint32_t number) {
  layer_key.number = number;
  return layer_key;
}

}  // namespace

std::optional<Bytes> TileFetcher::find(const CacheKey& layer_key, const ExpectedTile& tile) {
  auto cached = cache_.find(key_of(layer_key, tile.number), tile.digest);
  if (cached) ++from_cache_;
  return cached;
}

Result<std::map<std::uint32_t, Bytes>> TileFetcher::fetch(const CacheKey& layer_key,
                                                          const std::vector<ExpectedTile>& wanted,
                                                          const RequestFor& request_for,
                                                          const Stopped& stopped) {
  std::map<std::uint32_t, Bytes> tiles;
  std::set<std::uint32_t> missing;
  for (const ExpectedTile& tile : wanted) {
    if (auto cached = find(layer_key, tile)) {
      tiles[tile.number] = std::move(*cached);
    } else {
      missing.insert(tile.number);
    }
  }
  const TileSink take = [&](std::uint32_t number, const Bytes& tile) {
    tiles[number] = tile;
    return missing.erase(number) > 0;
  };
  while (!missing.empty()) {
    const Status fetched = with_retries(requests_.retry(), stopped, [&] {
      return fetch_once(layer_key, request_for(missing), take, stopped);
    });
    if (!fetched.ok()) return fetched.error();
  }
  return tiles;
}

Attempt TileFetcher::fetch_once(const CacheKey& layer_key, const CheckedRequest& request,
                                const TileSink& take, const Stopped& stopped) {
  Attempt attempt = fetch_from(Caches::allowed, layer_key, request, take, stopped);
  const bool is_damaged = !attempt.status.ok() && attempt.status.error().code == ErrorCode::corrupt;
  if (!is_damaged) return attempt;
  return fetch_from(Caches::bypassed, layer_key, request, take, stopped);
}

Attempt TileFetcher::fetch_from(Caches caches, const CacheKey& layer_key,
                                const CheckedRequest& request, const TileSink& take,
                                const Stopped& stopped) {
  bool advanced = false;
  TileCutter cutter(request.url, request.expected, [&](std::uint32_t number, const Bytes& tile) {
    ++from_server_;
    cache_.store(key_of(layer_key, number), tile);
    if (take(number, tile)) advanced = true;
  });
  HttpAnswer answer = requests_.get(
      request.url, bytes_of(request.expected), caches,
      [&](ByteView piece) { return cutter.take(piece); }, stopped);
  if (answer.status.ok()) return {cutter.finish()};
  // Complete tiles of an interrupted response are kept; the next request fetches the rest.
  if (advanced && answer.status.error().code == ErrorCode::unavailable) return {};
  return {std::move(answer.status), answer.retry_after_s};
}

}  // namespace milepost
