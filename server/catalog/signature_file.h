// The signature of a map, a file beside it: "town.map.sig" of "town.map" (FORMAT.md 8).
#pragma once

#include <filesystem>
#include <string>

#include "schema/base/result.h"

namespace milepost::server {

inline constexpr const char* kSignatureExtension = ".sig";

std::filesystem::path signature_file_of(const std::filesystem::path& map_file);

// Whether the file is named as a signature, so that it is no map.
bool is_named_as_signature(const std::filesystem::path& file);

// The text of the map's signature, read at every call: a map may be signed while it is served. Who
// signed is not checked. Errors: not_found (no file, or it signs another name or build), corrupt,
// io.
Result<std::string> read_signature_of(const std::filesystem::path& map_file,
                                      const std::string& name, const std::string& build);

}  // namespace milepost::server
