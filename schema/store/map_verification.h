// Reads every byte of a map and says what is wrong with it.
#pragma once

#include <string>

#include "schema/store/map_store.h"
#include "schema/store/sqlite.h"

namespace milepost {

// `build` and `bounds` are those that the map tells of itself. Errors: corrupt, for what does not
// agree, with its place; io.
Status verify_map(const sqlite::Database& map, const std::string& build, const Bounds& bounds);

}  // namespace milepost
