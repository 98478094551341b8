// A map file as a source: no server, no cache.
#pragma once

#include <filesystem>

#include "client/fetch/map_source.h"

namespace milepost {

// Errors: those of MapReader::open.
Result<std::shared_ptr<MapSource>> open_file_source(const std::filesystem::path& map_file);

}  // namespace milepost
