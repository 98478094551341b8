// Where the cache's SQLite file lies in its folder, and what is done about a damaged one.
#pragma once

#include <filesystem>

#include "schema/base/result.h"
#include "schema/store/sqlite.h"

namespace milepost {

// The file in use is tiles-N.sqlite with the largest N of 1 to 999999. A damaged file is never
// renamed or replaced under its own name while another process may have it open (SQLite would then
// mix up the old file's journal and the new file's): its successor gets the next free N, and all
// processes move on to that one when they meet the damage.
struct CacheFile {
  sqlite::Database database;
  int generation = 0;
};

// Opens the newest file, made if there is none; a damaged one is set aside first.
// Errors: io, unavailable (locked).
Result<CacheFile> open_cache_file(const std::filesystem::path& folder);

// Opens the file after `damaged` (a generation), made unless another process has made it already.
// The damaged one stays as tiles-N.sqlite.damaged; older ones of that kind are removed.
// Errors: io, unavailable (locked).
Result<CacheFile> open_after_damage(const std::filesystem::path& folder, int damaged);

}  // namespace milepost
