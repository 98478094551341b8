#include "server/catalog/reader_pool.h"

#include <utility>

namespace milepost::server {

Result<std::unique_ptr<ReaderPool>> ReaderPool::open(std::shared_ptr<const HeldFile> file,
                                                     unsigned count) {
  Result<MapReader> first = MapReader::open(*file);
  if (!first) return first.error();
  return std::unique_ptr<ReaderPool>(new ReaderPool(std::move(file), count, std::move(*first)));
}

ReaderPool::ReaderPool(std::shared_ptr<const HeldFile> file, unsigned count, MapReader first)
    : file_(std::move(file)), to_open_(count - 1) {
  idle_.push_back(add(std::move(first)));
}

// REQUIRES: the mutex is held, or the pool is not shared yet.
MapReader* ReaderPool::add(MapReader reader) {
  readers_.push_back(std::make_unique<MapReader>(std::move(reader)));
  return readers_.back().get();
}

ReaderPool::Lease ReaderPool::lend() {
  std::unique_lock lock(mutex_);
  if (idle_.empty() && to_open_ > 0) {
    --to_open_;
    lock.unlock();
    Result<MapReader> another = MapReader::open(*file_);
    lock.lock();
    if (another) return {*this, add(std::move(*another))};
    ++to_open_;  // there is one reader at least, to wait for
  }
  returned_.wait(lock, [this] { return !idle_.empty(); });
  MapReader* reader = idle_.back();
  idle_.pop_back();
  return {*this, reader};
}

void ReaderPool::give_back(MapReader* reader) {
  {
    const std::lock_guard lock(mutex_);
    idle_.push_back(reader);
  }
  returned_.notify_one();
}

}  // namespace milepost::server
