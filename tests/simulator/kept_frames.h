// Frames that an earlier run of the simulator left in a drive's folder.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "schema/base/result.h"

namespace milepost::simulator {

// A file beside the frames that holds a digest of all that they depend on.
inline constexpr const char* kFrameDigestFile = "frames.digest";

// Whether the folder has frames of this digest, every one of them.
bool has_frames(const std::filesystem::path& folder, const std::string& digest,
                const std::vector<std::filesystem::path>& frames);

// Errors: io.
Status forget_frames(const std::filesystem::path& folder);
Status note_frames(const std::filesystem::path& folder, const std::string& digest);

}  // namespace milepost::simulator
