#include "client/cache/tile_cache.h"

#include <unistd.h>

#include <system_error>
#include <utility>

#include "client/cache/cache_file.h"
#include "schema/base/digest.h"

namespace milepost {
namespace {

// After a lock was refused, it is not requested again for this time: otherwise a vehicle would wait
// for it at every frame.
constexpr std::int64_t kPause_s = 10;

bool is_damage(const Status& status) {
  // invalid_input: the stored rows violate the tables' constraints.
  return !status.ok() && (status.error().code == ErrorCode::corrupt ||
                          status.error().code == ErrorCode::invalid_input);
}

}  // namespace

TileCache::TileCache(CacheSettings settings) : settings_(std::move(settings)) {}

Result<std::unique_ptr<TileCache>> TileCache::open(CacheSettings settings) {
  std::error_code ignored;
  std::filesystem::create_directories(settings.folder, ignored);
  if (::access(settings.folder.c_str(), R_OK | W_OK | X_OK) != 0) {
    return Error{ErrorCode::io, settings.folder.string(), "the cache folder cannot be written to",
                 "check its permissions, or name another folder"};
  }
  std::unique_ptr<TileCache> cache(new TileCache(std::move(settings)));
  cache->run(Kind::reading, [](CacheEntries&) { return ok_status(); });
  return cache;
}

void TileCache::run(Kind kind, const Operation& operation) {
  const std::lock_guard lock(mutex_);
  const std::int64_t paused_until_s =
      kind == Kind::reading ? reading_paused_until_s_ : writing_paused_until_s_;
  if (settings_.steady_s() < paused_until_s) {
    ++counters_.failures;
    return;
  }
  const Status opened = file_.has_value() ? ok_status() : open_file();
  const Status done = opened.ok() ? run_open(operation) : opened;
  if (done.ok()) return;
  ++counters_.failures;
  if (done.error().code == ErrorCode::unavailable) pause(opened.ok() ? kind : Kind::reading);
}

// A pause for reading also pauses writing.
void TileCache::pause(Kind kind) {
  writing_paused_until_s_ = settings_.steady_s() + kPause_s;
  if (kind == Kind::reading) reading_paused_until_s_ = writing_paused_until_s_;
}

// Opening a file is retried at each use: the disk may have space again.
Status TileCache::open_file() {
  auto opened = open_cache_file(settings_.folder);
  if (!opened.ok()) return opened.error();
  file_.emplace(OpenFile{CacheEntries(std::move(opened->database), settings_.limit_bytes),
                         opened->generation});
  const Status checked = run_open([](CacheEntries& entries) { return entries.check_total(); });
  if (checked.ok()) return checked;
  ++counters_.failures;
  if (checked.error().code == ErrorCode::unavailable) pause(Kind::writing);
  return file_.has_value() ? ok_status() : checked;
}

// REQUIRES: an open file. It is replaced if it turns out to be damaged.
Status TileCache::run_open(const Operation& operation) {
  Status done = operation(file_->entries);
  if (!is_damage(done)) return done;
  ++counters_.damaged_files;
  const int damaged = file_->generation;
  file_.reset();
  auto next = open_after_damage(settings_.folder, damaged);
  if (!next.ok()) return next.error();
  file_.emplace(
      OpenFile{CacheEntries(std::move(next->database), settings_.limit_bytes), next->generation});
  return done;
}

std::optional<Bytes> TileCache::find(const CacheKey& key) { return find_here(key, ""); }

std::optional<Bytes> TileCache::find(const CacheKey& key, const std::string& digest) {
  if (auto found = find_here(key, digest)) return found;
  std::optional<std::int64_t> other;
  run(Kind::reading, [&](CacheEntries& entries) -> Status {
    const auto id = entries.find_in_other_build(key, digest);
    if (!id.ok()) return id.error();
    other = *id;
    return ok_status();
  });
  if (!other) return std::nullopt;
  run(Kind::writing,
      [&](CacheEntries& entries) { return entries.move_to_build(*other, key.build); });
  return find_here(key, digest);
}

std::optional<Bytes> TileCache::find_here(const CacheKey& key, const std::string& digest) {
  std::optional<CacheEntries::Found> found;
  bool damaged = false;
  run(Kind::reading, [&](CacheEntries& entries) -> Status {
    auto entry = entries.find(key);
    if (!entry.ok()) return entry.error();
    found = std::move(entry).value();
    damaged = found.has_value() &&
              (!found->sound || (!digest.empty() && digest_of(found->content) != digest));
    if (damaged) ++counters_.damaged_entries;
    return ok_status();
  });
  if (!found.has_value()) return std::nullopt;
  if (damaged) {
    remove(key);
    return std::nullopt;
  }
  touch(key);
  return std::move(found->content);
}

void TileCache::touch(const CacheKey& key) {
  run(Kind::writing, [&](CacheEntries& entries) { return entries.mark_used(key); });
}

void TileCache::store(const CacheKey& key, ByteView content) {
  if (content.size() > settings_.limit_bytes) return;
  run(Kind::writing, [&](CacheEntries& entries) { return entries.store(key, content); });
}

void TileCache::remove(const CacheKey& key) {
  run(Kind::writing, [&](CacheEntries& entries) { return entries.remove(key); });
}

std::vector<CachedDocument> TileCache::segment_documents() {
  std::vector<CachedDocument> documents;
  run(Kind::reading, [&](CacheEntries& entries) -> Status {
    auto listed = entries.segment_documents();
    if (!listed.ok()) return listed.error();
    documents = std::move(listed).value();
    return ok_status();
  });
  return documents;
}

std::vector<CachedDocument> TileCache::map_documents() {
  std::vector<CachedDocument> documents;
  run(Kind::reading, [&](CacheEntries& entries) -> Status {
    auto listed = entries.map_documents();
    if (!listed.ok()) return listed.error();
    documents = std::move(listed).value();
    return ok_status();
  });
  return documents;
}

std::vector<CachedDocument> TileCache::signatures() {
  std::vector<CachedDocument> documents;
  run(Kind::reading, [&](CacheEntries& entries) -> Status {
    auto listed = entries.signatures();
    if (!listed.ok()) return listed.error();
    documents = std::move(listed).value();
    return ok_status();
  });
  return documents;
}

std::uint64_t TileCache::bytes() {
  std::uint64_t bytes = 0;
  run(Kind::reading, [&](CacheEntries& entries) -> Status {
    const Result<std::uint64_t> total = entries.bytes();
    if (!total.ok()) return total.error();
    bytes = *total;
    return ok_status();
  });
  return bytes;
}

CacheCounters TileCache::counters() const {
  const std::lock_guard lock(mutex_);
  return counters_;
}

}  // namespace milepost
