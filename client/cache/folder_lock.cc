#include "client/cache/folder_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <string>
#include <thread>
#include <utility>

namespace milepost {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr milliseconds kLongestWait{1000};
constexpr milliseconds kBetweenTries{20};

// Whether the lock was acquired. On failure `errno` is EWOULDBLOCK if another process held it all
// the time.
bool wait_for_lock(int descriptor) {
  const steady_clock::time_point end = steady_clock::now() + kLongestWait;
  for (;;) {
    if (::flock(descriptor, LOCK_EX | LOCK_NB) == 0) return true;
    if (errno != EWOULDBLOCK || steady_clock::now() >= end) return false;
    std::this_thread::sleep_for(kBetweenTries);
  }
}

}  // namespace

Result<FolderLock> FolderLock::take(const std::filesystem::path& folder) {
  const std::string file = (folder / "lock").string();
  // Without O_NONBLOCK, opening a file that is not regular (a FIFO) may block.
  FolderLock lock(::open(file.c_str(), O_CREAT | O_RDWR | O_CLOEXEC | O_NONBLOCK, 0666));
  if (lock.descriptor_ >= 0 && wait_for_lock(lock.descriptor_)) return lock;
  if (lock.descriptor_ >= 0 && errno == EWOULDBLOCK) {
    return Error{ErrorCode::unavailable, file, "another process holds the cache's lock",
                 "end that process"};
  }
  return Error{ErrorCode::io, file, "the cache's lock cannot be taken",
               "check the folder's permissions and the disk's space, or name another folder"};
}

FolderLock::~FolderLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

FolderLock::FolderLock(FolderLock&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)) {}

}  // namespace milepost
