// The cache's SQLite file in its folder, and the replacement of a damaged file.
#pragma once

#include <filesystem>

#include "schema/base/result.h"
#include "schema/store/sqlite.h"

namespace milepost {

// The file in use is tiles-N.sqlite with the largest N in [1, 999999]. A damaged file is never
// renamed or replaced under its own name while another process may have it open (SQLite would then
// mix up the journals of both files): its replacement gets the next free N, and every process
// switches to that one when it detects the damage.
struct CacheFile {
  sqlite::Database database;
  int generation = 0;
};

// Opens the newest file, created if there is none; a damaged one is replaced first. Errors: io,
// unavailable (locked).
Result<CacheFile> open_cache_file(const std::filesystem::path& folder);

// Opens the file that follows generation `damaged`, created unless another process has created it
// already. The damaged one is kept as tiles-N.sqlite.damaged; older ones of that kind are removed.
// Errors: io, unavailable (locked).
Result<CacheFile> open_after_damage(const std::filesystem::path& folder, int damaged);

}  // namespace milepost
