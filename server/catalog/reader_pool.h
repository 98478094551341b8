// A pool of readers of one map, for concurrent reads.
#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <vector>

#include "schema/store/map_store.h"

namespace milepost::server {

// Readers are opened when they are needed; all read the same file, even if it is replaced. Safe to
// use from several threads at once.
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

  // REQUIRES: count >= 1. Errors: those of MapReader::open.
  static Result<std::unique_ptr<ReaderPool>> open(std::shared_ptr<const HeldFile> file,
                                                  unsigned count);

  // Blocks while all readers are lent.
  Lease lend();

 private:
  ReaderPool(std::shared_ptr<const HeldFile> file, unsigned count, MapReader first);
  MapReader* add(MapReader reader);
  void give_back(MapReader* reader);

  const std::shared_ptr<const HeldFile> file_;
  std::mutex mutex_;
  std::condition_variable returned_;
  unsigned to_open_;  // guarded by mutex_, like all below
  std::vector<std::unique_ptr<MapReader>> readers_;
  std::vector<MapReader*> idle_;
};

}  // namespace milepost::server
