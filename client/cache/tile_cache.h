// The client's cache on disk: tiles, cells, and the documents that list them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "client/cache/cache_entries.h"
#include "client/cache/steady_clock.h"
#include "schema/base/bytes.h"
#include "schema/base/result.h"

namespace milepost {

struct CacheSettings {
  std::filesystem::path folder;             // created if missing
  std::uint64_t limit_bytes = 1ULL << 30U;  // of the contents; SQLite adds a few percent
  std::function<std::int64_t()> steady_s = steady_seconds;
};

// Counters since the cache was opened.
struct CacheCounters {
  std::uint64_t failures = 0;         // reads and writes that failed because of the disk or a lock
  std::uint64_t damaged_entries = 0;  // dropped: the bytes did not match the digest
  std::uint64_t damaged_files = 0;    // replaced
};

// One SQLite file, shared with other processes that use the same folder. The cache may lose
// entries: a full disk, a lock held too long and a damaged file are counted and otherwise behave
// like an empty cache. A process killed at any time leaves only complete entries. A lock held by
// another process is waited for a few seconds at most and then not requested for ten seconds; while
// another process writes, stored entries can still be read. Safe to use from several threads at
// once.
class TileCache {
 public:
  // Errors: io (the folder cannot be created or written to).
  static Result<std::unique_ptr<TileCache>> open(CacheSettings settings);

  // The content, if the entry exists and matches the digest stored with it; marks it as used.
  std::optional<Bytes> find(const CacheKey& key);
  // The same, also compared with a known digest. What another build of the map has under the same
  // key and digest becomes this build's: a new build fetches only what differs.
  std::optional<Bytes> find(const CacheKey& key, const std::string& digest);
  // Marks the entry as used, if it exists.
  void touch(const CacheKey& key);
  // Adds or replaces an entry, then evicts least recently used entries beyond the limit.
  void store(const CacheKey& key, ByteView content);
  void remove(const CacheKey& key);
  // The segment documents of each map's most recently used build.
  std::vector<CachedDocument> segment_documents();
  // The map document of each map's most recently used build, in order of the map names.
  std::vector<CachedDocument> map_documents();
  // The signatures of all builds.
  std::vector<CachedDocument> signatures();

  // The total size of the contents.
  std::uint64_t bytes();
  CacheCounters counters() const;

 private:
  enum class Kind { reading, writing };
  using Operation = std::function<Status(CacheEntries&)>;

  struct OpenFile {
    CacheEntries entries;
    int generation = 0;
  };

  explicit TileCache(CacheSettings settings);
  void run(Kind kind, const Operation& operation);
  std::optional<Bytes> find_here(const CacheKey& key, const std::string& digest);
  Status open_file();
  Status run_open(const Operation& operation);
  void pause(Kind kind);

  const CacheSettings settings_;
  mutable std::mutex mutex_;  // guards all below
  std::optional<OpenFile> file_;
  CacheCounters counters_;
  // Steady time until which no lock is requested.
  std::int64_t reading_paused_until_s_ = 0;
  std::int64_t writing_paused_until_s_ = 0;
};

}  // namespace milepost
