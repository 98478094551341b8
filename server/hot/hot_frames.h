// Encoded tiles and cells in memory: those that were used last.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <unordered_map>

#include "schema/base/bytes.h"
#include "server/hot/lru_cache.h"

namespace milepost::server {

using Frame = std::shared_ptr<const Bytes>;

// A frame is found by the digest of its content, whatever map it is in: a reload does not empty the
// memory. Frames enter when they have been read and their digest was checked; it is not checked
// again. Frames that somebody still holds are found, too, so that many slow readers of one range
// hold each frame once. Safe to use from several threads at once.
class HotFrames {
 public:
  // `bytes` of memory at most, apart from frames that others hold.
  explicit HotFrames(std::size_t bytes);

  // Null if it is not in memory.
  Frame find(std::string_view digest);
  // Returns the frame, or an equal one that is in memory already.
  Frame add(std::string_view digest, Frame frame);

 private:
  struct Shard {
    explicit Shard(std::size_t bytes) : frames(bytes) {}
    Frame held_frame(const std::string& digest) const;
    void forget_released();

    std::mutex mutex;
    LruCache<Frame> frames;                                            // guarded by mutex
    std::unordered_map<std::string, std::weak_ptr<const Bytes>> held;  // the same
    std::size_t forget_at = 64;  // entries of `held`, when those of no frame are removed
  };
  Shard& shard_of(std::string_view digest);

  std::array<std::unique_ptr<Shard>, 8> shards_;  // so that threads seldom wait for each other
};

}  // namespace milepost::server
