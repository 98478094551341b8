// Files that are whole at every instant: written beside their place, synced, then renamed into it.
// A symbolic link stays one: its place is where it leads. Nothing but a regular file is replaced.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "schema/base/result.h"

namespace milepost {

// The whole content of a file. Errors: not_found, io.
Result<std::string> read_text_file(const std::filesystem::path& path);

// A name beside `final_path` for content in the making: hidden, and unique to this process.
std::filesystem::path partial_path_for(const std::filesystem::path& final_path);

// Syncs `partial` to the disk and renames it to `final_path`; a reader sees the old file or the
// new one, whole, whatever happens meanwhile. Errors: io, also where something else than a regular
// file is (the partial file is then removed).
Status publish_file(const std::filesystem::path& partial, const std::filesystem::path& final_path);

// Replaces the file's content through a partial file and publish_file. A pipe or a device is
// written to as it is. Errors: io.
Status write_text_file(const std::filesystem::path& path, std::string_view content);

}  // namespace milepost
