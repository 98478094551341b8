// The entries of a cache file (schema/cache.sql) and their least-recently-used eviction.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "schema/base/bytes.h"
#include "schema/base/result.h"
#include "schema/store/sqlite.h"

namespace milepost {

// The key of an entry. Everything under a build is immutable, so an entry is never stale,
// except a signature.
struct CacheKey {
  std::string map;
  std::string build;
  std::string segment;       // empty: an entry of the whole map
  std::string layer;         // empty: a document
  std::uint32_t number = 0;  // the tile's index, or the cell's number

  static CacheKey map_document(std::string map, std::string build) {
    return {std::move(map), std::move(build), "", "", 0};
  }
  // The index of the map's cells.
  static CacheKey areas_document(std::string map, std::string build) {
    return {std::move(map), std::move(build), "", "", 1};
  }
  // What the build's digest covers.
  static CacheKey manifest(std::string map, std::string build) {
    return {std::move(map), std::move(build), "", "", 2};
  }
  // Of the build; the only entry whose content may change.
  static CacheKey signature(std::string map, std::string build) {
    return {std::move(map), std::move(build), "", "", 3};
  }
  static CacheKey segment_document(std::string map, std::string build, std::string segment) {
    return {std::move(map), std::move(build), std::move(segment), "", 0};
  }
};

struct CachedDocument {
  CacheKey key;
  std::string content;
};

// The entries of one open file. Values stored in the file are verified before use: contents by
// their digests, the total size by recomputing it from time to time; invalid use numbers are
// replaced. Errors of all: corrupt or invalid_input (the file violates the constraints of its
// tables), io, unavailable (locked by another process). Not safe to use from several threads at
// once.
class CacheEntries {
 public:
  struct Found {
    Bytes content;
    bool sound = false;  // the content has the digest and size stored with it
  };

  CacheEntries(sqlite::Database database, std::uint64_t limit_bytes);

  // Verifies the total size and evicts what exceeds the limit.
  Status check_total();

  Result<std::optional<Found>> find(const CacheKey& key);
  // The entry that differs from the key in its build alone and has the digest; its id, if any.
  Result<std::optional<std::int64_t>> find_in_other_build(const CacheKey& key,
                                                          const std::string& digest);
  // Makes it an entry of the key's build, if it still exists and the build has none.
  Status move_to_build(std::int64_t id, const std::string& build);
  // Marks the entry as the most recently used, if it exists.
  Status mark_used(const CacheKey& key);
  // Adds or replaces an entry, then evicts least recently used entries beyond the limit. REQUIRES:
  // the content is not longer than the limit.
  Status store(const CacheKey& key, ByteView content);
  Status remove(const CacheKey& key);
  // The segment documents of each map's most recently used build.
  Result<std::vector<CachedDocument>> segment_documents();
  // The map document of each map's most recently used build, in order of the map names.
  Result<std::vector<CachedDocument>> map_documents();
  // The signatures of all builds.
  Result<std::vector<CachedDocument>> signatures();
  Result<std::uint64_t> bytes();

 private:
  Result<bool> total_is_right();
  Result<bool> total_is_possible();
  Status count_anew();
  Status evict();
  Status replace(const CacheKey& key, ByteView content);
  Status mark_used_now(const CacheKey& key);
  Result<std::int64_t> next_use();
  Result<std::optional<std::int64_t>> latest_use();
  Status number_uses_anew();
  Error damaged(const std::string& what) const;
  Status in_transaction(const std::function<Status()>& work);
  Result<std::vector<CachedDocument>> documents(const char* query);

  sqlite::Database database_;
  std::int64_t limit_bytes_;
  int evicted_since_count_ = 0;  // entries
};

}  // namespace milepost
