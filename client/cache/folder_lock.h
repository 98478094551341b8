// The lock of the cache folder: one process at a time creates or replaces a cache file.
#pragma once

#include <filesystem>

#include "schema/base/result.h"

namespace milepost {

// Held until destruction, or until the process ends.
class FolderLock {
 public:
  // Waits for one second at most: a process that holds the lock longer hangs or is suspended.
  // Errors: unavailable (another process holds it), io.
  static Result<FolderLock> take(const std::filesystem::path& folder);

  ~FolderLock();
  FolderLock(FolderLock&& other) noexcept;
  FolderLock& operator=(FolderLock&&) = delete;

 private:
  explicit FolderLock(int descriptor) : descriptor_(descriptor) {}
  int descriptor_;  // of the open file, -1 once moved from
};

}  // namespace milepost
