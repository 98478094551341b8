#include "client/cache/cache_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <string>
#include <string_view>
#include <utility>

#include "client/cache/cache_sql.h"

namespace milepost {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPrefix = "tiles-";
constexpr std::string_view kSuffix = ".sqlite";
constexpr std::string_view kDamaged = ".damaged";
constexpr std::int64_t kApplicationId = 1297108785;  // as in cache.sql
constexpr std::int64_t kLayoutVersion = 1;           // as in cache.sql

// One process at a time makes a file or sets one aside. The lock ends with the process.
class FolderLock {
 public:
  explicit FolderLock(const fs::path& folder)
      : descriptor_(::open((folder / "lock").c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666)),
        held_(descriptor_ >= 0 && ::flock(descriptor_, LOCK_EX) == 0) {}
  ~FolderLock() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

  bool held() const { return held_; }

 private:
  int descriptor_;
  bool held_;
};

Error lock_error(const fs::path& folder) {
  return {ErrorCode::io, folder.string(), "the cache folder cannot be written to",
          "check its permissions and the disk's space, or name another folder"};
}

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
  return whole && generation > 0 ? generation : 0;
}

int newest_generation(const fs::path& folder) {
  int newest = 0;
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
    newest = std::max(newest, generation_of(entry.path().filename().string()));
  }
  return newest;
}

Result<std::int64_t> single_integer(const sqlite::Database& database, std::string_view query) {
  auto statement = database.prepare(query);
  if (!statement.ok()) return statement.error();
  const Result<bool> row = statement->step();
  if (!row.ok()) return row.error();
  return *row ? statement->integer(0) : 0;
}

Status make_tables(sqlite::Database& database) {
  Status made = database.execute("BEGIN IMMEDIATE;" + std::string(kCacheSql) + "COMMIT;");
  if (!made.ok()) static_cast<void>(database.execute("ROLLBACK"));
  return made;
}

// Makes the tables in an empty file; a file with other content is corrupt to us.
Status prepare_tables(sqlite::Database& database) {
  const auto tables = single_integer(database, "SELECT count(*) FROM sqlite_schema");
  if (!tables.ok()) return tables.error();
  if (*tables == 0) return make_tables(database);
  const auto id = single_integer(database, "PRAGMA application_id");
  if (!id.ok()) return id.error();
  const auto version = single_integer(database, "PRAGMA user_version");
  if (!version.ok()) return version.error();
  if (*id == kApplicationId && *version == kLayoutVersion) return ok_status();
  return Error{ErrorCode::corrupt, database.file().string(), "this is no cache of this version",
               ""};
}

Result<CacheFile> open_generation(const fs::path& folder, int generation) {
  auto database = sqlite::Database::open(file_of(folder, generation), sqlite::Access::read_write);
  if (!database.ok()) return database.error();
  // With a write-ahead log several processes read while one writes. Without a sync at each commit
  // a power cut may lose the last tiles, never the file. A locked cache is soon given up on.
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

// Its journal is of no use to anybody: a process that has it open keeps what it has open.
void set_aside(const fs::path& folder, int generation) {
  remove_earlier_damaged(folder);
  const std::string file = file_of(folder, generation).string();
  std::error_code ignored;
  fs::rename(file, file + std::string(kDamaged), ignored);
  fs::remove(file + "-wal", ignored);
  fs::remove(file + "-shm", ignored);
}

// REQUIRES: the folder's lock is held.
Result<CacheFile> make_next(const fs::path& folder, int damaged) {
  auto next = open_generation(folder, damaged + 1);
  if (next.ok()) set_aside(folder, damaged);
  return next;
}

}  // namespace

Result<CacheFile> open_cache_file(const fs::path& folder) {
  const FolderLock lock(folder);
  if (!lock.held()) return lock_error(folder);
  const int newest = std::max(newest_generation(folder), 1);
  auto opened = open_generation(folder, newest);
  const bool damaged = !opened.ok() && opened.error().code == ErrorCode::corrupt;
  return damaged ? make_next(folder, newest) : std::move(opened);
}

Result<CacheFile> open_after_damage(const fs::path& folder, int damaged) {
  const FolderLock lock(folder);
  if (!lock.held()) return lock_error(folder);
  const int newest = newest_generation(folder);
  return newest > damaged ? open_generation(folder, newest) : make_next(folder, damaged);
}

}  // namespace milepost
