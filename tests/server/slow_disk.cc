#include "tests/server/slow_disk.h"

#include <sqlite3.h>

#include <chrono>
#include <condition_variable>
#include <mutex>

#include "schema/store/held_database.h"

namespace milepost::server {
namespace {

struct Gate {
  std::mutex mutex;
  std::condition_variable changed;
  bool closed = false;  // guarded by mutex, like all below
  int blocked = 0;

  void pass() {
    std::unique_lock lock(mutex);
    ++blocked;
    changed.notify_all();
    changed.wait(lock, [this] { return !closed; });
    --blocked;
  }
  void set_closed(bool value) {
    const std::lock_guard lock(mutex);
    closed = value;
    changed.notify_all();
  }
};

Gate& gate() {
  static Gate gate;
  return gate;
}

// The functions for files that are held open, with a gate before each read.
sqlite3_vfs* system_files = nullptr;
const sqlite3_io_methods* system_methods = nullptr;
sqlite3_io_methods slow_methods;

int slow_read(sqlite3_file* file, void* bytes, int count, sqlite3_int64 offset) {
  gate().pass();
  return system_methods->xRead(file, bytes, count, offset);
}

int slow_open(sqlite3_vfs*, const char* name, sqlite3_file* file, int flags, int* out_flags) {
  const int opened = system_files->xOpen(system_files, name, file, flags, out_flags);
  if (opened != SQLITE_OK || (flags & SQLITE_OPEN_MAIN_DB) == 0) return opened;
  system_methods = file->pMethods;
  slow_methods = *system_methods;
  slow_methods.xRead = slow_read;
  slow_methods.iVersion = 1;  // no memory map
  file->pMethods = &slow_methods;
  return opened;
}

sqlite3_vfs& slow_files() {
  static sqlite3_vfs files = [] {
    system_files = sqlite3_vfs_find(sqlite::held_file_system());
    sqlite3_vfs copy = *system_files;  // of the same name, so that it is found first
    copy.xOpen = slow_open;
    return copy;
  }();
  return files;
}

}  // namespace

SlowDisk::SlowDisk() { sqlite3_vfs_register(&slow_files(), 0); }

SlowDisk::~SlowDisk() {
  release();
  sqlite3_vfs_unregister(&slow_files());
}

void SlowDisk::block() { gate().set_closed(true); }

void SlowDisk::release() { gate().set_closed(false); }

bool SlowDisk::wait_blocked(int reads) {
  std::unique_lock lock(gate().mutex);
  return gate().changed.wait_for(lock, std::chrono::seconds(30),
                                 [reads] { return gate().blocked >= reads; });
}

}  // namespace milepost::server
