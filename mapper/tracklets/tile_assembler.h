// Groups a layer's items into tiles and releases each tile as soon as it is complete.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "mapper/landmarks/landmark_mapper.h"
#include "schema/tile/database_frame.h"
#include "schema/tile/observation.h"
#include "schema/tile/tracklet.h"

namespace milepost {

// The range of an item on the road; it is stored in the tile in which the range begins.
inline AlongRange along_of(const Tracklet& tracklet) { return tracklet.along; }
inline AlongRange along_of(const ObservedTracklet& observed) { return observed.tracklet.along; }
inline AlongRange along_of(const MappedLandmark& landmark) { return landmark.along; }
inline AlongRange along_of(const DatabaseFrame& frame) { return {frame.along_m, frame.along_m}; }

// Not safe to use from several threads.
template <class Item>
class TileAssembler {
 public:
  struct Tile {
    std::uint32_t index = 0;
    AlongRange along;         // contains every item's
    std::vector<Item> items;  // by begin; those with equal begin, as they were added
  };

  explicit TileAssembler(double tile_length_m) : tile_length_m_(tile_length_m) {}

  void add(Item item) {
    const auto index = static_cast<std::uint32_t>(along_of(item).from_m / tile_length_m_);
    tiles_[index].push_back(std::move(item));
  }

  // The tiles to which no item beginning at `along_m` or later belongs, ascending; each is returned
  // once.
  std::vector<Tile> take_complete(double along_m) {
    std::vector<Tile> complete;
    while (!tiles_.empty() && (tiles_.begin()->first + 1) * tile_length_m_ <= along_m) {
      auto taken = tiles_.extract(tiles_.begin());
      Tile tile{taken.key(), along_of(taken.mapped().front()), std::move(taken.mapped())};
      std::stable_sort(tile.items.begin(), tile.items.end(), [](const Item& a, const Item& b) {
        return along_of(a).from_m < along_of(b).from_m;
      });
      for (const Item& item : tile.items) tile.along = tile.along.joined(along_of(item));
      complete.push_back(std::move(tile));
    }
    return complete;
  }

 private:
  double tile_length_m_;
  std::map<std::uint32_t, std::vector<Item>> tiles_;
};

}  // namespace milepost
