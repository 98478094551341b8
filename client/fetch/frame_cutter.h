// Cuts an answer into the stored frames that it must consist of, while it arrives.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "schema/base/bytes.h"
#include "schema/base/result.h"
#include "schema/store/map_store.h"

namespace milepost {

// A stored frame that an index names: a tile of a segment, or a cell of an area.
struct ExpectedFrame {
  std::uint32_t number = 0;  // the tile's index, or the cell's number
  std::uint64_t bytes = 0;
  std::string digest;
};

inline ExpectedFrame expected_frame(const TileEntry& entry) {
  return {entry.index, entry.bytes, entry.digest};
}
inline ExpectedFrame expected_frame(const CellEntry& entry) {
  return {entry.cell, entry.bytes, entry.digest};
}
template <class Entry>
std::vector<ExpectedFrame> expected_frames(const std::vector<Entry>& entries) {
  std::vector<ExpectedFrame> frames;
  frames.reserve(entries.size());
  for (const Entry& entry : entries) frames.push_back(expected_frame(entry));
  return frames;
}

// The index says which frames must come, how long each is and what its digest is, so nothing else
// is believed: not the order, not the count, not the bytes.
class FrameCutter {
 public:
  using Receiver = std::function<void(std::uint32_t number, Bytes frame)>;

  // `where` (the URL) goes into errors. `receive` is called once a frame, whole and checked.
  FrameCutter(std::string where, std::vector<ExpectedFrame> expected, Receiver receive);

  // The next piece of the answer. Errors: corrupt, naming the tile that is wrong.
  Status take(ByteView piece);
  // The answer has ended, as the server says. Errors: corrupt, naming the tile that is missing.
  Status finish() const;
  std::size_t received() const { return received_; }  // frames

 private:
  Status complete_frame();
  Error wrong(const std::string& what) const;

  std::string where_;
  std::vector<ExpectedFrame> expected_;
  Receiver receive_;
  std::size_t received_ = 0;
  Bytes begun_;  // of expected_[received_]
};

}  // namespace milepost
