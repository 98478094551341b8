// The signature of a map, a file beside it: "town.map.sig" of "town.map" (FORMAT.md 8).
#pragma once

#include <filesystem>
#include <string>

#include "schema/base/result.h"
#include "schema/document/signature.h"

namespace milepost::server {

inline constexpr const char* kSignatureExtension = ".sig";

std::filesystem::path signature_file_of(const std::filesystem::path& map_file);

// Whether the file is named as a signature, so that it is no map.
bool is_named_as_signature(const std::filesystem::path& file);

struct StoredSignature {
  SignedBuild about;
  std::string text;
};

// What lies beside the map's file. Who signed is not checked. Errors: not_found (no file), corrupt,
// io.
Result<StoredSignature> read_signature(const std::filesystem::path& map_file);

// The text of the signature beside the map's file. Errors: as above; not_found also if it signs
// another name or build.
Result<std::string> read_signature_of(const std::filesystem::path& map_file,
                                      const std::string& name, const std::string& build);

}  // namespace milepost::server
