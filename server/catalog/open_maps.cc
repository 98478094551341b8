#include "server/catalog/open_maps.h"

namespace milepost::server {
namespace {

Result<std::shared_ptr<const HeldFile>> file_of(const MapBuild& build) {
  if (build.held) return build.held;
  Result<HeldFile> opened = HeldFile::open(build.file);
  const bool is_same = opened.ok() && opened->identity() == build.identity;
  if (is_same) return std::make_shared<const HeldFile>(std::move(*opened));
  if (!opened && opened.error().code == ErrorCode::io) return opened.error();
  return Error{ErrorCode::gone, "build " + build.build, "is no longer in " + build.file.string(),
               "use the build that /v1/maps/" + build.map + " names"};
}

}  // namespace

Result<std::shared_ptr<const ServedMap>> OpenMaps::map(const MapBuild& build) {
  const Key key{build.map, build.build};
  const std::shared_ptr<Slot> slot = slot_of(key);
  const std::lock_guard reading(slot->reading);
  if (slot->map) return slot->map;
  const auto file = file_of(build);
  if (!file) return file.error();
  auto read = ServedMap::open(build.map, *file, limits_.readers, faults_);
  if (read && (*read)->build() != build.build) {
    read = Error{ErrorCode::corrupt, build.file.string(),
                 "holds build " + (*read)->build() + " where " + build.build + " was",
                 "replace map files by renaming, never in place"};
  }
  if (!read) {
    faults_->add(build.map, build.build, read.error());
    return read;
  }
  slot->map = *read;
  account(key, slot, (*read)->memory_bytes());
  return read;
}

void OpenMaps::add(std::shared_ptr<const ServedMap> map) {
  const Key key{map->name(), map->build()};
  const std::shared_ptr<Slot> slot = slot_of(key);
  const std::lock_guard reading(slot->reading);
  if (slot->map) return;
  const std::uint64_t bytes = map->memory_bytes();
  slot->map = std::move(map);
  account(key, slot, bytes);
}

std::shared_ptr<OpenMaps::Slot> OpenMaps::slot_of(const Key& key) {
  const std::lock_guard lock(mutex_);
  auto& slot = slots_[key];
  if (slot) {
    uses_.splice(uses_.begin(), uses_, slot->use);
  } else {
    slot = std::make_shared<Slot>();
    slot->use = uses_.insert(uses_.begin(), key);
    evict();
  }
  return slot;
}

void OpenMaps::account(const Key& key, const std::shared_ptr<Slot>& slot, std::uint64_t bytes) {
  const std::lock_guard lock(mutex_);
  const auto known = slots_.find(key);
  if (known == slots_.end() || known->second != slot) return;  // evicted meanwhile
  slot->bytes = bytes;
  bytes_ += bytes;
  evict();
}

// The latest stays, whatever its size.
void OpenMaps::evict() {
  while (uses_.size() > 1 && (uses_.size() > limits_.maps || bytes_ > limits_.bytes)) {
    const auto oldest = slots_.find(uses_.back());
    bytes_ -= oldest->second->bytes;
    slots_.erase(oldest);
    uses_.pop_back();
  }
}

}  // namespace milepost::server
