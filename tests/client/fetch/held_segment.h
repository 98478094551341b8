// A map of one segment in memory, for tests of its users.
#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "client/fetch/held_map.h"

namespace milepost::testing {

struct IndexedTile {
  AlongRange along;
  std::optional<DecodedTile> tile;    // none: not held ...
  std::optional<Error> failure = {};  // ... and why
};

inline std::shared_ptr<const SegmentLayer> layer_of(const SegmentKey& key, const RouteLine& line,
                                                    LayerParameters parameters,
                                                    const std::vector<IndexedTile>& tiles) {
  std::vector<TileEntry> index;
  for (const IndexedTile& tile : tiles) {
    TileEntry entry;
    entry.index = static_cast<std::uint32_t>(index.size());
    entry.along = tile.along;
    index.push_back(entry);
  }
  return std::make_shared<const SegmentLayer>(SegmentLayer{
      key, "layer", std::make_shared<const BuildLayer>(BuildLayer{{}, std::move(parameters), {}}),
      line, std::move(index)});
}

inline HeldMap held_map(std::shared_ptr<const SegmentLayer> layer,
                        const std::vector<IndexedTile>& tiles) {
  HeldSegment segment;
  segment.layer = layer;
  for (std::uint32_t i = 0; i < tiles.size(); ++i) {
    if (tiles[i].tile) segment.tiles[i] = std::make_shared<const DecodedTile>(*tiles[i].tile);
    if (tiles[i].failure) segment.missing.emplace(i, *tiles[i].failure);
  }
  HeldMap held;
  held.segments[layer->key] = std::make_shared<const HeldSegment>(std::move(segment));
  return held;
}

}  // namespace milepost::testing
