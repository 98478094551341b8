// The lock of the cache's folder: one process at a time makes a file or sets one aside.
#pragma once

#include <filesystem>

#include "schema/base/result.h"

namespace milepost {

// Held until the end of its life, or of the process.
class FolderLock {
 public:
  // Waits for a second at most: a process that holds the lock longer hangs or was stopped.
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
