// Which files of a directory are maps, and under which names they are served.
#pragma once

#include <filesystem>
#include <string>

#include "schema/base/result.h"

namespace milepost::server {

// Whether the file is a map by its type, its length and its first bytes. Never blocks on a FIFO or
// a device. Errors, with the reason: invalid_input (something else: a directory, a text; empty),
// corrupt (truncated), not_found (a dangling link), io.
Status check_map_file(const std::filesystem::path& file);

// Whether the file is named as a map.
bool is_named_as_map(const std::filesystem::path& file);

// The name under which a map file is served: its name without the extension. Errors: invalid_input
// (not usable in a URL, or the name of a copy or a partial file: "town.map.bak", "town.map~").
Result<std::string> map_name_of(const std::filesystem::path& file);

}  // namespace milepost::server
