// Cuts an answer into the stored tiles that it must consist of, while it arrives.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "schema/base/bytes.h"
#include "schema/base/result.h"
#include "schema/store/map_store.h"

namespace milepost {

// The segment's tile index says which tiles must come, how long each is and what its digest is, so
// nothing else is believed: not the order, not the count, not the bytes.
class FrameCutter {
 public:
  using Receiver = std::function<void(const TileEntry& entry, Bytes frame)>;

  // `where` (the URL) goes into errors. `receive` is called once a tile, whole and checked.
  FrameCutter(std::string where, std::vector<TileEntry> expected, Receiver receive);

  // The next piece of the answer. Errors: corrupt, naming the tile that is wrong.
  Status take(ByteView piece);
  // The answer has ended, as the server says. Errors: corrupt, naming the tile that is missing.
  Status finish() const;
  std::size_t received() const { return received_; }  // tiles

 private:
  Status complete_tile();
  Error wrong(const std::string& what) const;

  std::string where_;
  std::vector<TileEntry> expected_;
  Receiver receive_;
  std::size_t received_ = 0;
  Bytes begun_;  // of expected_[received_]
};

}  // namespace milepost
