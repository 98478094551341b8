#include "tests/simulator/kept_frames.h"

#include <algorithm>
#include <system_error>

#include "schema/base/file.h"

namespace milepost::simulator {
namespace fs = std::filesystem;

bool has_frames(const fs::path& folder, const std::string& digest,
                const std::vector<fs::path>& frames) {
  const Result<std::string> noted = read_text_file(folder / kFrameDigestFile);
  if (!noted || *noted != digest + "\n") return false;
  return std::all_of(frames.begin(), frames.end(), [&](const fs::path& frame) {
    std::error_code error;
    return fs::is_regular_file(folder / frame, error);
  });
}

Status forget_frames(const fs::path& folder) {
  std::error_code error;
  fs::remove(folder / kFrameDigestFile, error);
  if (!error) return ok_status();
  return Error{ErrorCode::io, (folder / kFrameDigestFile).string(),
               "cannot be removed (" + error.message() + ")", "check the permissions"};
}

Status note_frames(const fs::path& folder, const std::string& digest) {
  return write_text_file(folder / kFrameDigestFile, digest + "\n");
}

}  // namespace milepost::simulator
