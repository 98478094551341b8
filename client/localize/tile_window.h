// The tiles of one layer of one segment around the vehicle, decoded.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "client/fetch/map_source.h"

namespace milepost {

// A layer of one segment of one build, and where it comes from.
struct LayerSource {
  std::shared_ptr<MapSource> source;
  MapVersion version;
  std::string segment;
  std::string layer;
};

struct WindowReach {
  double ahead_m = 60;   // fetched beyond what is needed, so that not every frame asks the source
  double behind_m = 60;  // kept behind what is needed
};

// Not safe to use from several threads at once.
template <class Tile>
class TileWindow {
 public:
  using Decode = Result<Tile> (*)(ByteView);

  TileWindow(LayerSource from, const WindowReach& reach, Decode decode)
      : from_(std::move(from)), reach_(reach), decode_(decode) {}

  // Makes sure that every tile with an item that meets `range` is held; fetches and lets go.
  // Whether the tiles held have changed. After an error what was held is held still. Errors: those
  // of MapSource::tiles, corrupt (a tile).
  Result<bool> cover(const AlongRange& range) {
    const bool covered = covered_.from_m <= range.from_m && range.to_m <= covered_.to_m;
    if (covered) return false;
    const AlongRange wanted = {range.from_m - reach_.behind_m, range.to_m + reach_.ahead_m};
    const Result<std::vector<TileFrame>> frames =
        from_.source->tiles(from_.version, from_.segment, from_.layer, wanted);
    if (!frames) return frames.error();

    std::map<std::uint32_t, Tile> tiles;
    for (const TileFrame& frame : *frames) {
      if (auto held = tiles_.extract(frame.index)) {
        tiles.insert(std::move(held));
        continue;
      }
      Result<Tile> tile = decode_(frame.frame);
      if (!tile) {
        tiles_.merge(tiles);
        return tile.error();
      }
      tiles.emplace(frame.index, std::move(*tile));
    }
    tiles_ = std::move(tiles);
    covered_ = wanted;
    return true;
  }

  const std::map<std::uint32_t, Tile>& tiles() const { return tiles_; }

 private:
  LayerSource from_;
  WindowReach reach_;
  Decode decode_;
  AlongRange covered_{0, -1};
  std::map<std::uint32_t, Tile> tiles_;
};

}  // namespace milepost
