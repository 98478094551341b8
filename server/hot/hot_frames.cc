#include "server/hot/hot_frames.h"

#include <algorithm>
#include <functional>
#include <utility>

namespace milepost::server {

HotFrames::HotFrames(std::size_t bytes) {
  for (auto& shard : shards_) shard = std::make_unique<Shard>(bytes / shards_.size());
}

Frame HotFrames::find(std::string_view digest) {
  Shard& shard = shard_of(digest);
  const std::lock_guard lock(shard.mutex);
  Frame hot = shard.frames.find(digest);
  return hot ? hot : shard.held_frame(std::string(digest));
}

Frame HotFrames::add(std::string_view digest, Frame frame) {
  Shard& shard = shard_of(digest);
  const std::string key(digest);
  const std::lock_guard lock(shard.mutex);
  if (Frame held = shard.held_frame(key)) frame = std::move(held);
  shard.frames.add(digest, frame, frame->size());
  shard.held[key] = frame;
  shard.forget_released();
  return frame;
}

// Null if nobody holds it.
Frame HotFrames::Shard::held_frame(const std::string& digest) const {
  const auto found = held.find(digest);
  return found == held.end() ? nullptr : found->second.lock();
}

void HotFrames::Shard::forget_released() {
  if (held.size() < forget_at) return;
  std::erase_if(held, [](const auto& entry) { return entry.second.expired(); });
  forget_at = std::max<std::size_t>(64, 2 * held.size());
}

HotFrames::Shard& HotFrames::shard_of(std::string_view digest) {
  return *shards_[std::hash<std::string_view>()(digest) % shards_.size()];
}

}  // namespace milepost::server
