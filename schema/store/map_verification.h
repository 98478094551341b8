// Checks every byte of a map.
#pragma once

#include <string>

#include "schema/store/map_store.h"
#include "schema/store/sqlite.h"

namespace milepost {

// `build` and `stated` are those that the map states. Errors: corrupt, which names the location of
// the first contradiction; io.
Status verify_map(const sqlite::Database& map, const std::string& build, const MapSummary& stated);

}  // namespace milepost
