// A disk that does not answer for a while.
#pragma once

namespace milepost::server {

// Files that SQLite opens while it exists are on this disk: from block() to release() their reads
// do not end.
class SlowDisk {
 public:
  SlowDisk();
  ~SlowDisk();  // release()
  SlowDisk(const SlowDisk&) = delete;
  SlowDisk& operator=(const SlowDisk&) = delete;

  void block();
  void release();
  // Waits until so many reads are blocked. False if that takes more than 30 s.
  bool wait_blocked(int reads);
};

}  // namespace milepost::server
