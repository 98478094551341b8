// A pool of readers of one map, for concurrent reads.
#pragma once

#include <condition_variable>
#include <filesystem>
#include <memory>
#include <mutex>
#include <vector>

#include "schema/store/map_store.h"

namespace milepost::server {

// All readers are opened together, so that they read one build even if the file is replaced later.
// Safe to use from several threads at once.
class ReaderPool {
 public:
  // A reader for one thread; it is returned to the pool when the lease ends.
  class Lease {
   public:
    Lease(ReaderPool& pool, MapReader* reader) : pool_(pool), reader_(reader) {}
    ~Lease() { pool_.give_back(reader_); }
    Lease(const Lease&) = delete;
    Lease& operator=(const Lease&) = delete;
    const MapReader& operator*() const { return *reader_; }
    const MapReader* operator->() const { return reader_; }

   private:
    ReaderPool& pool_;
    MapReader* reader_;
  };

  // REQUIRES: count >= 1. Errors: those of MapReader::open; unavailable if the file was replaced
  // meanwhile.
  static Result<std::unique_ptr<ReaderPool>> open(const std::filesystem::path& file,
                                                  unsigned count);

  // Blocks while all readers are lent.
  Lease lend();

 private:
  explicit ReaderPool(std::vector<MapReader> readers);
  void give_back(MapReader* reader);

  // Constant after construction.
  std::vector<MapReader> readers_;

  std::mutex mutex_;
  std::condition_variable returned_;
  std::vector<MapReader*> idle_;  // guarded by mutex_
};

}  // namespace milepost::server
