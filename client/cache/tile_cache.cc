#include "client/cache/tile_cache.h"

#include <unistd.h>

#include <system_error>
#include <utility>

#include "schema/base/digest.h"

namespace milepost {
namespace {

constexpr char kKeyIs[] =
    " map = ?1 AND build = ?2 AND segment = ?3 AND layer = ?4 AND number = ?5";

// Rolls back unless it was committed.
class Transaction {
 public:
  explicit Transaction(sqlite::Database& database) : database_(database) {}
  ~Transaction() {
    if (open_) static_cast<void>(database_.execute("ROLLBACK"));
  }
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;

  Status begin() {
    Status begun = database_.execute("BEGIN IMMEDIATE");
    open_ = begun.ok();
    return begun;
  }
  Status commit() {
    Status committed = database_.execute("COMMIT");
    if (committed.ok()) open_ = false;
    return committed;
  }

 private:
  sqlite::Database& database_;
  bool open_ = false;
};

void bind_key(sqlite::Statement& statement, const CacheKey& key) {
  statement.bind(1, std::string_view(key.map))
      .bind(2, std::string_view(key.build))
      .bind(3, std::string_view(key.segment))
      .bind(4, std::string_view(key.layer))
      .bind(5, static_cast<std::int64_t>(key.number));
}

// An entry as it was read, not checked yet.
struct Row {
  std::string digest;
  std::int64_t last_use_s = 0;
  Bytes content;
};

Result<std::optional<Row>> read_row(sqlite::Database& database, const CacheKey& key) {
  auto select = database.prepare(
      std::string("SELECT digest, last_use_s, content FROM entries WHERE") + kKeyIs);
  if (!select.ok()) return select.error();
  bind_key(*select, key);
  const Result<bool> found = select->step();
  if (!found.ok()) return found.error();
  if (!*found) return std::optional<Row>();
  const ByteView content = select->blob(2);
  return std::optional<Row>(
      Row{select->text(0), select->integer(1), Bytes(content.begin(), content.end())});
}

Status delete_row(sqlite::Database& database, const CacheKey& key) {
  auto statement = database.prepare(std::string("DELETE FROM entries WHERE") + kKeyIs);
  if (!statement.ok()) return statement.error();
  bind_key(*statement, key);
  return statement->run();
}

Status set_last_use(sqlite::Database& database, const CacheKey& key, std::int64_t now_s) {
  auto update = database.prepare(std::string("UPDATE entries SET last_use_s = ?6 WHERE") + kKeyIs +
                                 " AND last_use_s <> ?6");
  if (!update.ok()) return update.error();
  bind_key(*update, key);
  update->bind(6, now_s);
  return update->run();
}

Status insert_row(sqlite::Database& database, const CacheKey& key, ByteView content,
                  std::int64_t now_s) {
  auto insert = database.prepare(
      "INSERT INTO entries (map, build, segment, layer, number, digest, bytes, last_use_s, content)"
      " VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9)");
  if (!insert.ok()) return insert.error();
  bind_key(*insert, key);
  const std::string digest = digest_of(content);
  insert->bind(6, std::string_view(digest))
      .bind(7, static_cast<std::int64_t>(content.size()))
      .bind(8, now_s)
      .bind(9, content);
  return insert->run();
}

Result<std::uint64_t> total_bytes(sqlite::Database& database) {
  auto select = database.prepare("SELECT bytes FROM total");
  if (!select.ok()) return select.error();
  const Result<bool> row = select->step();
  if (!row.ok()) return row.error();
  return static_cast<std::uint64_t>(*row ? select->integer(0) : 0);
}

// Removes the least recently used entries until the rest keeps within the limit.
Status evict(sqlite::Database& database, std::uint64_t limit_bytes) {
  auto remove_oldest = database.prepare(
      "DELETE FROM entries WHERE id ="
      " (SELECT id FROM entries ORDER BY last_use_s, layer = '', id LIMIT 1)");
  if (!remove_oldest.ok()) return remove_oldest.error();
  for (;;) {
    const Result<std::uint64_t> total = total_bytes(database);
    if (!total.ok()) return total.error();
    if (*total <= limit_bytes) return ok_status();
    Status removed = remove_oldest->run();
    if (!removed.ok() || database.changes() == 0) return removed;
  }
}

Status replace_row(sqlite::Database& database, const CacheKey& key, ByteView content,
                   std::int64_t now_s, std::uint64_t limit_bytes) {
  Transaction transaction(database);
  Status done = transaction.begin();
  if (done.ok()) done = delete_row(database, key);
  if (done.ok()) done = insert_row(database, key, content, now_s);
  if (done.ok()) done = evict(database, limit_bytes);
  return done.ok() ? transaction.commit() : done;
}

constexpr char kSegmentDocuments[] =
    "SELECT map, build, segment, digest, content FROM entries AS e"
    " WHERE layer = '' AND segment <> '' AND build ="
    " (SELECT build FROM entries WHERE layer = '' AND segment <> '' AND map = e.map"
    "  ORDER BY last_use_s DESC, id DESC LIMIT 1)";
constexpr char kMapDocuments[] =
    "SELECT map, build, segment, digest, content FROM entries AS e"
    " WHERE layer = '' AND segment = '' AND number = 0 AND build ="
    " (SELECT build FROM entries WHERE layer = '' AND segment = '' AND number = 0 AND map = e.map"
    "  ORDER BY last_use_s DESC, id DESC LIMIT 1) ORDER BY map";

Status read_documents(sqlite::Database& database, const char* query,
                      std::vector<CachedDocument>& documents) {
  auto select = database.prepare(query);
  if (!select.ok()) return select.error();
  for (;;) {
    const Result<bool> row = select->step();
    if (!row.ok()) return row.error();
    if (!*row) return ok_status();
    if (digest_of(select->blob(4)) != select->text(3)) continue;
    CacheKey key;
    key.map = select->text(0);
    key.build = select->text(1);
    key.segment = select->text(2);
    documents.push_back({std::move(key), select->text(4)});
  }
}

}  // namespace

Result<std::unique_ptr<TileCache>> TileCache::open(CacheSettings settings) {
  std::error_code ignored;
  std::filesystem::create_directories(settings.folder, ignored);
  if (::access(settings.folder.c_str(), R_OK | W_OK | X_OK) != 0) {
    return Error{ErrorCode::io, settings.folder.string(), "the cache folder cannot be written to",
                 "check its permissions, or name another folder"};
  }
  std::unique_ptr<TileCache> cache(new TileCache(std::move(settings)));
  cache->run(
      [&](sqlite::Database& database) { return evict(database, cache->settings_.limit_bytes); });
  return cache;
}

void TileCache::run(const Operation& operation) {
  const std::lock_guard lock(mutex_);
  const Status done = run_locked(operation);
  if (!done.ok()) ++counters_.failures;
}

// A file that could not be opened is tried again each time: the disk may have room again.
Status TileCache::run_locked(const Operation& operation) {
  if (!file_.has_value()) {
    auto opened = open_cache_file(settings_.folder);
    if (!opened.ok()) return opened.error();
    file_ = std::move(opened).value();
  }
  Status done = operation(file_->database);
  if (done.ok() || done.error().code != ErrorCode::corrupt) return done;
  ++counters_.damaged_files;
  const int damaged = file_->generation;
  file_.reset();
  auto next = open_after_damage(settings_.folder, damaged);
  if (next.ok()) file_ = std::move(next).value();
  return done;
}

std::optional<Bytes> TileCache::find(const CacheKey& key) { return find(key, ""); }

std::optional<Bytes> TileCache::find(const CacheKey& key, const std::string& digest) {
  std::optional<Bytes> content;
  run([&](sqlite::Database& database) -> Status {
    auto row = read_row(database, key);
    if (!row.ok()) return row.error();
    if (!row->has_value()) return ok_status();
    const Row& read = **row;
    const std::string actual = digest_of(read.content);
    if (actual != read.digest || (!digest.empty() && actual != digest)) {
      ++counters_.damaged_entries;
      return delete_row(database, key);
    }
    content = std::move((*row)->content);
    const std::int64_t now_s = settings_.now_s();
    return read.last_use_s == now_s ? ok_status() : set_last_use(database, key, now_s);
  });
  return content;
}

void TileCache::touch(const CacheKey& key) {
  run([&](sqlite::Database& database) { return set_last_use(database, key, settings_.now_s()); });
}

void TileCache::store(const CacheKey& key, ByteView content) {
  if (content.size() > settings_.limit_bytes) return;
  run([&](sqlite::Database& database) {
    return replace_row(database, key, content, settings_.now_s(), settings_.limit_bytes);
  });
}

void TileCache::remove(const CacheKey& key) {
  run([&](sqlite::Database& database) { return delete_row(database, key); });
}

std::vector<CachedDocument> TileCache::segment_documents() {
  std::vector<CachedDocument> documents;
  run([&](sqlite::Database& database) {
    return read_documents(database, kSegmentDocuments, documents);
  });
  return documents;
}

std::vector<CachedDocument> TileCache::map_documents() {
  std::vector<CachedDocument> documents;
  run([&](sqlite::Database& database) {
    return read_documents(database, kMapDocuments, documents);
  });
  return documents;
}

std::uint64_t TileCache::bytes() {
  std::uint64_t bytes = 0;
  run([&](sqlite::Database& database) -> Status {
    const Result<std::uint64_t> total = total_bytes(database);
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
