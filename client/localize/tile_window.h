// The tiles of one layer of one segment around the vehicle.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "client/fetch/documents.h"
#include "client/fetch/held_map.h"

namespace milepost {

struct WindowReach {
  double ahead_m = 60;   // loaded beyond what is needed, to change the window rarely
  double behind_m = 60;  // kept behind what is needed

  AlongRange around(const AlongRange& range) const {
    return {range.from_m - behind_m, range.to_m + ahead_m};
  }
};

// The coverage of the requested range.
struct Covered {
  bool changed = false;                         // the set of tiles has changed
  bool complete = true;                         // every tile with an item in the range is there
  std::optional<Error> failure = std::nullopt;  // why one is missing whose request failed
};

// Not safe to use from several threads at once.
template <class Tile>
class TileWindow {
 public:
  using Tiles = std::map<std::uint32_t, std::shared_ptr<const DecodedTile>>;

  TileWindow(SegmentKey segment, const WindowReach& reach)
      : segment_(std::move(segment)), reach_(reach) {}

  // Loads from the held map every tile with an item that meets `range`, and those around it;
  // discards the others. A loaded tile stays even if it is no longer held.
  Covered cover(const HeldMap& held, const AlongRange& range) {
    const bool inside = covered_.from_m <= range.from_m && range.to_m <= covered_.to_m;
    if (inside && is_whole_) return {};
    const HeldSegment* segment = held.find(segment_);
    if (segment == nullptr || !segment->layer) {
      return {false, false, segment == nullptr ? std::nullopt : segment->failure};
    }
    if (!inside) covered_ = reach_.around(range);
    is_whole_ = true;
    Covered covered;
    Tiles taken;
    for (const TileEntry& entry : entries_meeting(segment->layer->index, covered_)) {
      if (auto tile = find(*segment, entry.index)) {
        taken.emplace(entry.index, std::move(tile));
        continue;
      }
      is_whole_ = false;
      if (!entry.along.meets(range)) continue;
      covered.complete = false;
      const auto missing = segment->missing.find(entry.index);
      if (missing != segment->missing.end() && !covered.failure) covered.failure = missing->second;
    }
    covered.changed = taken != tiles_;
    tiles_ = std::move(taken);
    return covered;
  }

  // Calls `use` with each tile, by ascending index.
  template <class Use>
  void for_each(const Use& use) const {
    for (const auto& [index, tile] : tiles_) {
      if (const Tile* of_kind = std::get_if<Tile>(tile.get())) use(*of_kind);
    }
  }

 private:
  std::shared_ptr<const DecodedTile> find(const HeldSegment& segment, std::uint32_t index) const {
    if (const auto mine = tiles_.find(index); mine != tiles_.end()) return mine->second;
    const auto held = segment.tiles.find(index);
    return held == segment.tiles.end() ? nullptr : held->second;
  }

  SegmentKey segment_;
  WindowReach reach_;
  AlongRange covered_{0, -1};
  bool is_whole_ = false;
  Tiles tiles_;
};

}  // namespace milepost
