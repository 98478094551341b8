// The maps that are in memory, of all that are served: those that were asked for last.
#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "schema/base/result.h"
#include "server/catalog/map_build.h"
#include "server/catalog/map_faults.h"
#include "server/catalog/served_map.h"
#include "server/catalog/signatures.h"

namespace milepost::server {

struct OpenMapLimits {
  std::size_t maps = 64;              // each holds its file open
  std::uint64_t bytes = 128U << 20U;  // of memory, about
  unsigned readers = 1;               // of each, for threads that read tiles at once
};

// Safe to use from several threads at once.
class OpenMaps {
 public:
  OpenMaps(const OpenMapLimits& limits, std::shared_ptr<MapFaults> faults)
      : limits_(limits), faults_(std::move(faults)) {}

  // The map, from memory or from its file: blocks while it is read. Several that ask at once wait
  // for one reading. Errors: those of ServedMap::open; gone if another file took the place of one
  // that was not held open.
  Result<std::shared_ptr<const ServedMap>> map(const MapBuild& build);

  // A map that has just been read.
  void add(std::shared_ptr<const ServedMap> map);

  const OpenMapLimits& limits() const { return limits_; }
  const std::shared_ptr<MapFaults>& faults() const { return faults_; }
  Signatures& signatures() { return signatures_; }

 private:
  using Key = std::pair<std::string, std::string>;  // map, build
  struct Slot {
    std::mutex reading;
    std::shared_ptr<const ServedMap> map;  // guarded by `reading`
    std::uint64_t bytes = 0;               // guarded by mutex_, like all below
    std::list<Key>::iterator use;
  };

  std::shared_ptr<Slot> slot_of(const Key& key);
  void account(const Key& key, const std::shared_ptr<Slot>& slot, std::uint64_t bytes);
  void evict();

  const OpenMapLimits limits_;
  const std::shared_ptr<MapFaults> faults_;
  Signatures signatures_;  // of all that are served; synchronizes itself
  std::mutex mutex_;
  std::map<Key, std::shared_ptr<Slot>> slots_;
  std::list<Key> uses_;  // the latest first
  std::uint64_t bytes_ = 0;
};

}  // namespace milepost::server
