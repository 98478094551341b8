#include "client/cache/cache_file.h"

#include <algorithm>
#include <charconv>
#include <string>
#include <string_view>
#include <utility>

#include "client/cache/cache_sql.h"
#include "client/cache/folder_lock.h"

namespace milepost {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPrefix = "tiles-";
constexpr std::string_view kSuffix = ".sqlite";
constexpr std::string_view kDamaged = ".damaged";
constexpr int kLastGeneration = 999999;  // a file with a greater number is not the cache's
constexpr std::int64_t kApplicationId = 1297108785;  // as in cache.sql
constexpr std::int64_t kLayoutVersion = 4;           // as in cache.sql

fs::path file_of(const fs::path& folder, int generation) {
  return folder / (std::string(kPrefix) + std::to_string(generation) + std::string(kSuffix));
}

// The N of tiles-N.sqlite; 0 for other names.
int generation_of(std::string_view name) {
  if (!name.starts_with(kPrefix) || !name.ends_with(kSuffix)) return 0;
  const std::string_view digits =
      name.substr(kPrefix.size(), name.size() - kPrefix.size() - kSuffix.size());
  int generation = 0;
  const auto [end, error] =
      std::from_chars(digits.data(), digits.data() + digits.size(), generation);
  const bool whole = error == std::errc() && end == digits.data() + digits.size();
  return whole && generation > 0 && generation <= kLastGeneration ? generation : 0;
}

// 0 if there is none.
int newest_generation(const fs::path& folder) {
  int newest = 0;
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
    if (!entry.is_regular_file(ignored)) continue;
    newest = std::max(newest, generation_of(entry.path().filename().string()));
  }
  return newest;
}

Status make_tables(sqlite::Database& database) {
  Status made = database.execute("BEGIN IMMEDIATE;" + std::string(kCacheSql) + "COMMIT;");
  if (!made.ok()) static_cast<void>(database.execute("ROLLBACK"));
  return made;
}

// Creates the tables in an empty file; a file with other content is treated as corrupt.
Status prepare_tables(sqlite::Database& database) {
  const auto tables = database.integer("SELECT count(*) FROM sqlite_schema");
  if (!tables.ok()) return tables.error();
  if (*tables == 0) return make_tables(database);
  const auto id = database.integer("PRAGMA application_id");
  if (!id.ok()) return id.error();
  const auto version = database.integer("PRAGMA user_version");
  if (!version.ok()) return version.error();
  if (*id == kApplicationId && *version == kLayoutVersion) return ok_status();
  return Error{ErrorCode::corrupt, database.file().string(), "not a cache file of this version",
               ""};
}

Result<CacheFile> open_generation(const fs::path& folder, int generation) {
  auto database = sqlite::Database::open(file_of(folder, generation), sqlite::Access::read_write);
  if (!database.ok()) return database.error();
  // In WAL mode several processes read while one writes. Without a sync at each commit a power
  // failure may lose the latest tiles, but never damages the file. A short busy timeout gives up on
  // a locked cache soon.
  const Status set = database->execute(
      "PRAGMA busy_timeout = 1000;"
      "PRAGMA journal_mode = WAL;"
      "PRAGMA synchronous = NORMAL;"
      "PRAGMA journal_size_limit = 4194304;");
  if (!set.ok()) return set.error();
  const Status prepared = prepare_tables(*database);
  if (!prepared.ok()) return prepared.error();
  return CacheFile{std::move(database).value(), generation};
}

void remove_earlier_damaged(const fs::path& folder) {
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
    if (entry.path().extension() == kDamaged) fs::remove(entry.path(), ignored);
  }
}

// The journal is deleted: a process that has the file open keeps its open files.
void set_aside(const fs::path& folder, int generation) {
  remove_earlier_damaged(folder);
  const std::string file = file_of(folder, generation).string();
  std::error_code ignored;
  fs::rename(file, file + std::string(kDamaged), ignored);
  fs::remove(file + "-wal", ignored);
  fs::remove(file + "-shm", ignored);
}

// The first generation after `generation` whose file name is free; the last generation wraps around
// to the first.
int free_generation_after(const fs::path& folder, int generation) {
  std::error_code ignored;
  do {
    generation = generation < kLastGeneration ? generation + 1 : 1;
  } while (fs::exists(file_of(folder, generation), ignored));
  return generation;
}

// REQUIRES: the folder's lock is held.
Result<CacheFile> make_next(const fs::path& folder, int damaged) {
  auto next = open_generation(folder, free_generation_after(folder, damaged));
  if (next.ok()) set_aside(folder, damaged);
  return next;
}

}  // namespace

Result<CacheFile> open_cache_file(const fs::path& folder) {
  const auto lock = FolderLock::take(folder);
  if (!lock.ok()) return lock.error();
  const int newest = newest_generation(folder);
  if (newest == 0) return open_generation(folder, free_generation_after(folder, 0));
  auto opened = open_generation(folder, newest);
  const bool damaged = !opened.ok() && opened.error().code == ErrorCode::corrupt;
  return damaged ? make_next(folder, newest) : std::move(opened);
}

Result<CacheFile> open_after_damage(const fs::path& folder, int damaged) {
  const auto lock = FolderLock::take(folder);
  if (!lock.ok()) return lock.error();
  const int newest = newest_generation(folder);
  const bool made_already = newest != damaged && newest != 0;
  return made_already ? open_generation(folder, newest) : make_next(folder, damaged);
}

}  // namespace milepost
