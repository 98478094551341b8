// Values that both the writer and the reader of a map compute from its tables.
#pragma once

#include <string>

#include "schema/base/result.h"
#include "schema/store/map_store.h"
#include "schema/store/sqlite.h"

namespace milepost {

// PRAGMA application_id and user_version of map.sql.
inline constexpr std::int64_t kMapApplicationId = 0x4D504D31;  // "MPM1"
inline constexpr std::int64_t kMapFormatVersion = 2;

// The digest of the map's content (FORMAT.md 2.7).
Result<std::string> build_of(const sqlite::Database& map);

// The smallest box around all vertices and cells; zeros without either.
Result<Bounds> bounds_of(const sqlite::Database& map);

}  // namespace milepost
