// drive.json: the metadata of a drive.
#pragma once

#include <filesystem>
#include <string>

#include "schema/base/result.h"
#include "schema/drive/drive.h"

namespace milepost {

inline constexpr const char* kDescriptionFile = "drive.json";

// Reads and checks `folder`/drive.json into a drive without frames. Unknown keys are ignored.
// Errors: not_found, io; invalid_input that names the location in the JSON or the key.
Result<Drive> read_description(const std::filesystem::path& folder);

// Reads and checks only the camera of a drive.json file of any name; other keys may be missing.
// Errors: those of read_description.
Result<Camera> read_camera(const std::filesystem::path& file);

// The text of drive.json. REQUIRES: a local drive has its origin.
// Errors: invalid_input for a text that is not UTF-8.
Result<std::string> description_text(const Drive& drive);

}  // namespace milepost
