// What lies in a directory of maps: which of it is a map, and under which name it is served.
#pragma once

#include <filesystem>
#include <string>

#include "schema/base/result.h"

namespace milepost::server {

// Whether the file is a map by its kind, its length and its first bytes. Never waits for a FIFO or
// a device. Errors, with the reason why it is none: invalid_input (something else: a directory, a
// text), corrupt (empty or cut off), not_found (a link to nowhere), io.
Status check_map_file(const std::filesystem::path& file);

// Whether the file is meant to be a map by its name.
bool is_named_as_map(const std::filesystem::path& file);

// The name under which a map file is served: its name without the extension. Errors: invalid_input
// (it cannot stand in a URL, or it is that of a copy or a part: "town.map.bak", "town.map~").
Result<std::string> map_name_of(const std::filesystem::path& file);

}  // namespace milepost::server
