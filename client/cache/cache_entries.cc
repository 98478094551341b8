#include "client/cache/cache_entries.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "schema/base/digest.h"

namespace milepost {
namespace {

constexpr std::int64_t kLastUse = std::int64_t{1} << 62;  // far from overflow
// The stored total is recomputed after this many evictions that relied on it: often enough that a
// wrong total does little harm, rarely enough that recomputing it is cheap.
constexpr int kEvictionsPerCount = 64;

constexpr char kKeyIs[] =
    " map = ?1 AND build = ?2 AND segment = ?3 AND layer = ?4 AND number = ?5";

constexpr char kSegmentDocuments[] =
    "SELECT map, build, segment, digest, content FROM entries AS e"
    " WHERE layer = '' AND segment <> '' AND build ="
    " (SELECT build FROM entries WHERE layer = '' AND segment <> '' AND map = e.map"
    "  ORDER BY last_use DESC, id DESC LIMIT 1)";
constexpr char kMapDocuments[] =
    "SELECT map, build, segment, digest, content FROM entries AS e"
    " WHERE layer = '' AND segment = '' AND number = 0 AND build ="
    " (SELECT build FROM entries WHERE layer = '' AND segment = '' AND number = 0 AND map = e.map"
    "  ORDER BY last_use DESC, id DESC LIMIT 1) ORDER BY map";
constexpr char kSignatures[] =
    "SELECT map, build, segment, digest, content FROM entries"
    " WHERE layer = '' AND segment = '' AND number = 3";

void bind_key(sqlite::Statement& statement, const CacheKey& key) {
  statement.bind(1, std::string_view(key.map))
      .bind(2, std::string_view(key.build))
      .bind(3, std::string_view(key.segment))
      .bind(4, std::string_view(key.layer))
      .bind(5, static_cast<std::int64_t>(key.number));
}

std::int64_t size_of(ByteView content) { return static_cast<std::int64_t>(content.size()); }

}  // namespace

CacheEntries::CacheEntries(sqlite::Database database, std::uint64_t limit_bytes)
    : database_(std::move(database)),
      limit_bytes_(static_cast<std::int64_t>(
          std::min<std::uint64_t>(limit_bytes, std::numeric_limits<std::int64_t>::max()))) {}

Status CacheEntries::check_total() {
  const Result<bool> right = total_is_right();
  if (!right.ok()) return right.error();
  if (*right) return ok_status();
  return in_transaction([this] {
    Status counted = count_anew();
    return counted.ok() ? evict() : counted;
  });
}

Result<std::optional<CacheEntries::Found>> CacheEntries::find(const CacheKey& key) {
  auto select =
      database_.prepare(std::string("SELECT digest, bytes, content FROM entries WHERE") + kKeyIs);
  if (!select.ok()) return select.error();
  bind_key(*select, key);
  const Result<bool> there = select->step();
  if (!there.ok()) return there.error();
  if (!*there) return std::optional<Found>();
  const ByteView content = select->blob(2);
  const bool sound =
      digest_of(content) == select->text(0) && size_of(content) == select->integer(1);
  return std::optional<Found>(Found{Bytes(content.begin(), content.end()), sound});
}

Result<std::optional<std::int64_t>> CacheEntries::find_in_other_build(const CacheKey& key,
                                                                      const std::string& digest) {
  auto select = database_.prepare(
      "SELECT id FROM entries WHERE digest = ?6 AND map = ?1 AND build <> ?2 AND segment = ?3"
      " AND layer = ?4 AND number = ?5 LIMIT 1");
  if (!select.ok()) return select.error();
  bind_key(*select, key);
  select->bind(6, std::string_view(digest));
  const Result<bool> there = select->step();
  if (!there.ok()) return there.error();
  if (!*there) return std::optional<std::int64_t>();
  return std::optional(select->integer(0));
}

Status CacheEntries::move_to_build(std::int64_t id, const std::string& build) {
  auto update = database_.prepare("UPDATE OR IGNORE entries SET build = ?1 WHERE id = ?2");
  if (!update.ok()) return update.error();
  update->bind(1, std::string_view(build)).bind(2, id);
  return update->run();
}

Status CacheEntries::mark_used(const CacheKey& key) {
  return in_transaction([&] { return mark_used_now(key); });
}

Status CacheEntries::store(const CacheKey& key, ByteView content) {
  return in_transaction([&] { return replace(key, content); });
}

Status CacheEntries::remove(const CacheKey& key) {
  auto statement = database_.prepare(std::string("DELETE FROM entries WHERE") + kKeyIs);
  if (!statement.ok()) return statement.error();
  bind_key(*statement, key);
  return statement->run();
}

Result<std::vector<CachedDocument>> CacheEntries::segment_documents() {
  return documents(kSegmentDocuments);
}

Result<std::vector<CachedDocument>> CacheEntries::map_documents() {
  return documents(kMapDocuments);
}

Result<std::vector<CachedDocument>> CacheEntries::signatures() { return documents(kSignatures); }

Result<std::uint64_t> CacheEntries::bytes() {
  const Result<std::int64_t> total = database_.integer("SELECT bytes FROM total");
  if (!total.ok()) return total.error();
  return static_cast<std::uint64_t>(std::max<std::int64_t>(*total, 0));
}

// Whether the stored total is the sum over the entries and within the limit.
Result<bool> CacheEntries::total_is_right() {
  const Result<bool> possible = total_is_possible();
  if (!possible.ok() || !*possible) return possible;
  // total() cannot overflow, as sum() can.
  const Result<std::int64_t> equal = database_.integer(
      "SELECT (SELECT bytes FROM total) = (SELECT total(bytes) FROM entries) AND"
      " NOT EXISTS (SELECT 1 FROM entries WHERE bytes < 0)");
  if (!equal.ok()) return equal.error();
  return *equal == 1;
}

// Whether the stored total is a single value that store() can have left.
Result<bool> CacheEntries::total_is_possible() {
  const Result<std::int64_t> possible =
      database_.integer("SELECT count(*) = 1 AND min(bytes) BETWEEN 0 AND " +
                        std::to_string(limit_bytes_) + " FROM total");
  if (!possible.ok()) return possible.error();
  return *possible == 1;
}

// Recomputes the total; entries of an impossible size are deleted. REQUIRES, like all functions
// below: an open transaction.
Status CacheEntries::count_anew() {
  evicted_since_count_ = 0;
  // The total is deleted first, so that no trigger fails on a wrong value.
  return database_.execute(
      "DELETE FROM total;"
      "DELETE FROM entries WHERE bytes < 0 OR bytes > " +
      std::to_string(limit_bytes_) +
      ";INSERT INTO total SELECT coalesce(sum(bytes), 0) FROM entries;");
}

Status CacheEntries::evict() {
  auto remove_oldest = database_.prepare(
      "DELETE FROM entries WHERE id ="
      " (SELECT id FROM entries ORDER BY last_use + 1000 * (layer = '') LIMIT 1)");
  if (!remove_oldest.ok()) return remove_oldest.error();
  bool removing = true;
  for (;;) {
    const Result<std::uint64_t> total = bytes();
    if (!total.ok()) return total.error();
    if (*total <= static_cast<std::uint64_t>(limit_bytes_)) return ok_status();
    if (!removing && evicted_since_count_ == 0) {
      return damaged("its oldest entry cannot be removed");
    }
    if (!removing || evicted_since_count_ >= kEvictionsPerCount) {
      Status counted = count_anew();
      if (!counted.ok()) return counted;
      removing = true;
      continue;
    }
    Status removed = remove_oldest->run();
    if (!removed.ok()) return removed;
    removing = database_.changes() > 0;
    if (removing) ++evicted_since_count_;
  }
}

Status CacheEntries::replace(const CacheKey& key, ByteView content) {
  const Result<bool> possible = total_is_possible();
  if (!possible.ok()) return possible.error();
  if (!*possible) {
    Status counted = count_anew();
    if (!counted.ok()) return counted;
  }
  Status removed = remove(key);
  if (!removed.ok()) return removed;
  const Result<std::int64_t> use = next_use();
  if (!use.ok()) return use.error();
  auto insert = database_.prepare(
      "INSERT INTO entries (map, build, segment, layer, number, digest, bytes, last_use, content)"
      " VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9)");
  if (!insert.ok()) return insert.error();
  bind_key(*insert, key);
  const std::string digest = digest_of(content);
  insert->bind(6, std::string_view(digest))
      .bind(7, size_of(content))
      .bind(8, *use)
      .bind(9, content);
  Status inserted = insert->run();
  return inserted.ok() ? evict() : inserted;
}

Status CacheEntries::mark_used_now(const CacheKey& key) {
  const Result<std::int64_t> use = next_use();
  if (!use.ok()) return use.error();
  // An entry that is already the latest keeps its number.
  auto update = database_.prepare(std::string("UPDATE entries SET last_use = ?6 WHERE") + kKeyIs +
                                  " AND last_use < ?6 - 1");
  if (!update.ok()) return update.error();
  bind_key(*update, key);
  update->bind(6, *use);
  return update->run();
}

// The next use number: greater than that of any entry.
Result<std::int64_t> CacheEntries::next_use() {
  Result<std::optional<std::int64_t>> latest = latest_use();
  if (latest.ok() && !latest->has_value()) {
    const Status numbered = number_uses_anew();
    if (!numbered.ok()) return numbered.error();
    latest = latest_use();
  }
  if (!latest.ok()) return latest.error();
  if (!latest->has_value()) return damaged("its use numbers are invalid");
  return **latest + 1;
}

// The greatest use number, 0 without entries; none if it is invalid.
Result<std::optional<std::int64_t>> CacheEntries::latest_use() {
  auto select = database_.prepare(
      "SELECT last_use, last_use BETWEEN 0 AND ?1 FROM entries ORDER BY last_use DESC LIMIT 1");
  if (!select.ok()) return select.error();
  select->bind(1, kLastUse);
  const Result<bool> there = select->step();
  if (!there.ok()) return there.error();
  if (!*there) return std::optional<std::int64_t>(0);
  if (select->integer(1) != 1) return std::optional<std::int64_t>();
  return std::optional<std::int64_t>(select->integer(0));
}

// Renumbers the uses from 1, keeping their order; an invalid number is damage on the disk.
Status CacheEntries::number_uses_anew() {
  return database_.execute(
      "UPDATE entries SET last_use = place FROM (SELECT id AS placed,"
      " row_number() OVER (ORDER BY last_use, id) AS place FROM entries) WHERE id = placed");
}

Error CacheEntries::damaged(const std::string& what) const {
  return {ErrorCode::corrupt, database_.file().string(), what, ""};
}

Status CacheEntries::in_transaction(const std::function<Status()>& work) {
  Status done = database_.execute("BEGIN IMMEDIATE");
  if (!done.ok()) return done;
  done = work();
  if (done.ok()) done = database_.execute("COMMIT");
  if (!done.ok()) static_cast<void>(database_.execute("ROLLBACK"));
  return done;
}

Result<std::vector<CachedDocument>> CacheEntries::documents(const char* query) {
  auto select = database_.prepare(query);
  if (!select.ok()) return select.error();
  std::vector<CachedDocument> documents;
  for (;;) {
    const Result<bool> row = select->step();
    if (!row.ok()) return row.error();
    if (!*row) return documents;
    if (digest_of(select->blob(4)) != select->text(3)) continue;
    CacheKey key;
    key.map = select->text(0);
    key.build = select->text(1);
    key.segment = select->text(2);
    documents.push_back({std::move(key), select->text(4)});
  }
}

}  // namespace milepost
