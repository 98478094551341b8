// What the vehicle keeps on disk: tiles and cells, and the documents that tell which there are.
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
  std::filesystem::path folder;             // made if need be
  std::uint64_t limit_bytes = 1ULL << 30U;  // of the contents; SQLite adds a few percent
  std::function<std::int64_t()> steady_s = steady_seconds;
};

// Counts since the cache was opened.
struct CacheCounters {
  std::uint64_t failures = 0;         // reads and stores that the disk or a lock refused
  std::uint64_t damaged_entries = 0;  // dropped, for their bytes did not match their digest
  std::uint64_t damaged_files = 0;    // set aside
};

// One SQLite file, shared with other processes that name the same folder. It is allowed to forget:
// a full disk, a lock held too long and a damaged file are counted and otherwise look like an empty
// cache. A process killed at any instant leaves whole entries only. A lock of another process is
// waited for a few seconds at most, and then not asked for again for ten seconds; while another
// process writes, what is stored is still found.
// Safe to use from several threads at once.
class TileCache {
 public:
  // Errors: io (the folder cannot be made or written to).
  static Result<std::unique_ptr<TileCache>> open(CacheSettings settings);

  // The content, if it is there and has the digest it was stored with, and counts as a use.
  std::optional<Bytes> find(const CacheKey& key);
  // The same for one whose digest is known.
  std::optional<Bytes> find(const CacheKey& key, const std::string& digest);
  // Counts as a use of the entry, if it is there.
  void touch(const CacheKey& key);
  // Adds or replaces an entry, and removes the least recently used ones beyond the limit.
  void store(const CacheKey& key, ByteView content);
  void remove(const CacheKey& key);
  // The segment documents of each map's most recently used build.
  std::vector<CachedDocument> segment_documents();
  // The map document of each map's most recently used build, by the map's name.
  std::vector<CachedDocument> map_documents();

  // Of all contents.
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
  Status open_file();
  Status run_open(const Operation& operation);
  void pause(Kind kind);

  const CacheSettings settings_;
  mutable std::mutex mutex_;  // guards all below
  std::optional<OpenFile> file_;
  CacheCounters counters_;
  // Until then no lock is asked for.
  std::int64_t reading_paused_until_s_ = 0;
  std::int64_t writing_paused_until_s_ = 0;
};

}  // namespace milepost
