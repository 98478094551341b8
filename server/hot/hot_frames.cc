#include "server/hot/hot_frames.h"

#include <functional>

namespace milepost::server {

HotFrames::HotFrames(std::size_t bytes) {
  for (auto& shard : shards_) shard = std::make_unique<Shard>(bytes / shards_.size());
}

Frame HotFrames::find(std::string_view digest) {
  Shard& shard = shard_of(digest);
  const std::lock_guard lock(shard.mutex);
  return shard.frames.find(digest);
}

void HotFrames::add(std::string_view digest, const Frame& frame) {
  Shard& shard = shard_of(digest);
  const std::lock_guard lock(shard.mutex);
  shard.frames.add(digest, frame, frame->size());
}

HotFrames::Shard& HotFrames::shard_of(std::string_view digest) {
  return *shards_[std::hash<std::string_view>()(digest) % shards_.size()];
}

}  // namespace milepost::server
