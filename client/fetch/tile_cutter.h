// Cuts an answer into the encoded tiles that it must consist of, while it arrives.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "schema/base/bytes.h"
#include "schema/base/result.h"
#include "schema/store/map_store.h"

namespace milepost {

// An encoded tile that an index names: a tile of a segment, or a cell of an area.
struct ExpectedTile {
  std::uint32_t number = 0;  // the tile's index, or the cell's number
  std::uint64_t bytes = 0;
  std::string digest;
};

inline ExpectedTile expected_tile(const TileEntry& entry) {
  return {entry.index, entry.bytes, entry.digest};
}
inline ExpectedTile expected_tile(const CellEntry& entry) {
  return {entry.cell, entry.bytes, entry.digest};
}
template <class Entry>
std::vector<ExpectedTile> expected_tiles(const std::vector<Entry>& entries) {
  std::vector<ExpectedTile> tiles;
  tiles.reserve(entries.size());
  for (const Entry& entry : entries) tiles.push_back(expected_tile(entry));
  return tiles;
}

// The index says which tiles must come, how long each is and what its digest is, so nothing else
// is believed: not the order, not the count, not the bytes.
class TileCutter {
 public:
  using Receiver = std::function<void(std::uint32_t number, Bytes tile)>;

  // `where` (the URL) goes into errors. `receive` is called once a tile, whole and checked.
  TileCutter(std::string where, std::vector<ExpectedTile> expected, Receiver receive);

  // The next piece of the answer. Errors: corrupt, naming the tile that is wrong.
  Status take(ByteView piece);
  // The answer has ended, as the server says. Errors: corrupt, naming the tile that is missing.
  Status finish() const;
  std::size_t received() const { return received_; }  // tiles

 private:
  Status complete_tile();
  Error wrong(const std::string& what) const;

  std::string where_;
  std::vector<ExpectedTile> expected_;
  Receiver receive_;
  std::size_t received_ = 0;
  Bytes begun_;  // of expected_[received_]
};

}  // namespace milepost
