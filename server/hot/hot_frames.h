// Encoded tiles and cells in memory: those that were used last.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <mutex>
#include <string_view>

#include "schema/base/bytes.h"
#include "server/hot/lru_cache.h"

namespace milepost::server {

using Frame = std::shared_ptr<const Bytes>;

// A frame is found by the digest of its content, whatever map it is in: a reload does not empty the
// memory. Frames enter when they have been read and their digest was checked; it is not checked
// again. Safe to use from several threads at once.
class HotFrames {
 public:
  // `bytes` of memory at most.
  explicit HotFrames(std::size_t bytes);

  // Null if it is not in memory.
  Frame find(std::string_view digest);
  void add(std::string_view digest, const Frame& frame);

 private:
  struct Shard {
    explicit Shard(std::size_t bytes) : frames(bytes) {}
    std::mutex mutex;
    LruCache<Frame> frames;  // guarded by mutex
  };
  Shard& shard_of(std::string_view digest);

  std::array<std::unique_ptr<Shard>, 8> shards_;  // so that threads seldom wait for each other
};

}  // namespace milepost::server
