// Answers in memory, by the target of the request: those that were used last.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <mutex>
#include <string_view>

#include "server/catalog/catalog.h"
#include "server/hot/lru_cache.h"
#include "server/hot/prepared.h"

namespace milepost::server {

// Answers of one catalog to GET without conditions; a request with another catalog empties the
// memory. An answer keeps no map in memory (Prepared::map). Safe to use from several threads at
// once.
class HotAnswers {
 public:
  // `bytes` of memory at most, without tiles and cells.
  explicit HotAnswers(std::size_t bytes);

  // Null if it is not in memory.
  PreparedAnswer find(std::string_view target, const std::shared_ptr<const Catalog>& catalog);
  // Keeps a response with status 200 and a tag, the answer of `catalog` to `target`; others are not
  // a function of the catalog, or are not worth it.
  void add(std::string_view target, const std::shared_ptr<const Catalog>& catalog,
           const PreparedAnswer& answer);

 private:
  struct Shard {
    explicit Shard(std::size_t bytes) : answers(bytes) {}
    std::mutex mutex;
    std::shared_ptr<const Catalog> catalog;  // guarded by mutex: whose answers these are
    LruCache<PreparedAnswer> answers;        // guarded by mutex
  };
  Shard& shard_of(std::string_view target);
  void keep_only(const std::shared_ptr<const Catalog>& catalog);

  std::array<std::unique_ptr<Shard>, 8> shards_;  // so that threads seldom wait for each other
};

}  // namespace milepost::server
