#include "client/fetch/tile_cutter.h"

#include <algorithm>
#include <utility>

#include "schema/base/digest.h"

namespace milepost {

TileCutter::TileCutter(std::string where, std::vector<ExpectedTile> expected, Receiver receive)
    : where_(std::move(where)), expected_(std::move(expected)), receive_(std::move(receive)) {}

Status TileCutter::take(ByteView piece) {
  while (!piece.empty()) {
    if (received_ == expected_.size()) return wrong("bytes follow the last tile of the range");
    const std::size_t lacking = expected_[received_].bytes - begun_.size();
    const ByteView part = piece.first(std::min(lacking, piece.size()));
    begun_.insert(begun_.end(), part.begin(), part.end());
    piece = piece.subspan(part.size());
    if (part.size() < lacking) continue;
    Status completed = complete_tile();
    if (!completed.ok()) return completed;
  }
  return ok_status();
}

Status TileCutter::complete_tile() {
  const ExpectedTile& tile = expected_[received_];
  if (digest_of(begun_) != tile.digest) {
    return wrong("the bytes of tile " + std::to_string(tile.number) +
                 " do not have the digest that the index gives");
  }
  ++received_;
  receive_(tile.number, std::exchange(begun_, {}));
  return ok_status();
}

Status TileCutter::finish() const {
  if (received_ == expected_.size()) return ok_status();
  return wrong("the response ends before the end of tile " +
               std::to_string(expected_[received_].number));
}

Error TileCutter::wrong(const std::string& what) const {
  return {ErrorCode::corrupt, where_, what,
          "verify the server's map and check proxies between the client and the server"};
}

}  // namespace milepost
