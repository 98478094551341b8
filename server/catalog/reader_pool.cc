#include "server/catalog/reader_pool.h"

namespace milepost::server {

Result<std::unique_ptr<ReaderPool>> ReaderPool::open(const std::filesystem::path& file,
                                                     unsigned count) {
  std::vector<MapReader> readers;
  for (unsigned i = 0; i < count; ++i) {
    Result<MapReader> reader = MapReader::open(file);
    if (!reader) return reader.error();
    readers.push_back(std::move(*reader));
    if (readers.back().build() != readers.front().build()) {
      return Error{ErrorCode::unavailable, file.string(), "was replaced while it was being opened",
                   "start again"};
    }
  }
  return std::unique_ptr<ReaderPool>(new ReaderPool(std::move(readers)));
}

ReaderPool::ReaderPool(std::vector<MapReader> readers) : readers_(std::move(readers)) {
  for (MapReader& reader : readers_) idle_.push_back(&reader);
}

ReaderPool::Lease ReaderPool::lend() {
  std::unique_lock lock(mutex_);
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
