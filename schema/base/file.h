// Atomic file replacement: content is written to a partial file in the same folder, synced, then
// renamed. A symbolic link is kept and its target replaced. Only regular files are replaced.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "schema/base/result.h"

namespace milepost {

// The whole content of a file. Errors: not_found, io.
Result<std::string> read_text_file(const std::filesystem::path& path);

// The path of a partial file in the folder of `final_path`: hidden, and unique to this process.
std::filesystem::path partial_path_for(const std::filesystem::path& final_path);

// Syncs `partial` to the disk and renames it to `final_path`; a reader sees either the complete old
// file or the complete new one at any time. Errors: io, also if `final_path` exists and is not a
// regular file (the partial file is then removed).
Status publish_file(const std::filesystem::path& partial, const std::filesystem::path& final_path);

// Replaces the file's content through a partial file and publish_file. A pipe or a device is
// written to directly. Errors: io.
Status write_text_file(const std::filesystem::path& path, std::string_view content);

}  // namespace milepost
