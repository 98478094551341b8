// Splits a response stream into the encoded tiles that it must consist of.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "schema/base/bytes.h"
#include "schema/base/result.h"
#include "schema/store/map_store.h"

namespace milepost {

// An encoded tile listed by an index: a tile of a segment, or of a cell.
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

// The index defines the tiles, their sizes and their digests; the order, the count and every byte
// of the response are verified against it.
class TileCutter {
 public:
  using Receiver = std::function<void(std::uint32_t number, Bytes tile)>;

  // `where` (the URL) is used in error messages. `receive` is called once per tile, after the tile
  // is complete and verified.
  TileCutter(std::string where, std::vector<ExpectedTile> expected, Receiver receive);

  // Takes the next piece of the response. Errors: corrupt, naming the tile that is wrong.
  Status take(ByteView piece);
  // To be called at the end of the response. Errors: corrupt, naming the tile that is missing.
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
