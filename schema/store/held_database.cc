#include "schema/store/held_database.h"

#include <sqlite3.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>

namespace milepost::sqlite {
namespace {

constexpr const char* kName = "milepost-held";
constexpr int kSectorBytes = 4096;

// A file of SQLite (https://www.sqlite.org/c3ref/io_methods.html) that is a descriptor of somebody
// else's.
struct HeldOsFile {
  sqlite3_file base;  // first, as SQLite requires
  int descriptor;
};

int descriptor_of(sqlite3_file* file) { return reinterpret_cast<HeldOsFile*>(file)->descriptor; }

int close(sqlite3_file* /*file*/) { return SQLITE_OK; }

int read(sqlite3_file* file, void* out, int bytes, sqlite3_int64 at) {
  auto* const begin = static_cast<char*>(out);
  std::size_t done = 0;
  const auto wanted = static_cast<std::size_t>(bytes);
  while (done < wanted) {
    const ssize_t read = ::pread(descriptor_of(file), begin + done, wanted - done,
                                 at + static_cast<sqlite3_int64>(done));
    if (read < 0 && errno == EINTR) continue;
    if (read < 0) return SQLITE_IOERR_READ;
    if (read == 0) break;
    done += static_cast<std::size_t>(read);
  }
  if (done == wanted) return SQLITE_OK;
  std::memset(begin + done, 0, wanted - done);  // as SQLite requires
  return SQLITE_IOERR_SHORT_READ;
}

int file_size(sqlite3_file* file, sqlite3_int64* bytes) {
  struct stat status {};
  if (::fstat(descriptor_of(file), &status) != 0) return SQLITE_IOERR_FSTAT;
  *bytes = status.st_size;
  return SQLITE_OK;
}

int no_write(sqlite3_file* /*file*/, const void* /*bytes*/, int /*count*/, sqlite3_int64 /*at*/) {
  return SQLITE_READONLY;
}
int no_truncate(sqlite3_file* /*file*/, sqlite3_int64 /*bytes*/) { return SQLITE_READONLY; }
int no_sync(sqlite3_file* /*file*/, int /*flags*/) { return SQLITE_OK; }
int no_lock(sqlite3_file* /*file*/, int /*level*/) { return SQLITE_OK; }
int not_reserved(sqlite3_file* /*file*/, int* is_reserved) {
  *is_reserved = 0;
  return SQLITE_OK;
}
int no_control(sqlite3_file* /*file*/, int /*operation*/, void* /*argument*/) {
  return SQLITE_NOTFOUND;
}
int sector_bytes(sqlite3_file* /*file*/) { return kSectorBytes; }
int characteristics(sqlite3_file* /*file*/) { return SQLITE_IOCAP_IMMUTABLE; }

constexpr sqlite3_io_methods methods() {
  sqlite3_io_methods all{};
  all.iVersion = 1;
  all.xClose = close;
  all.xRead = read;
  all.xWrite = no_write;
  all.xTruncate = no_truncate;
  all.xSync = no_sync;
  all.xFileSize = file_size;
  all.xLock = no_lock;
  all.xUnlock = no_lock;
  all.xCheckReservedLock = not_reserved;
  all.xFileControl = no_control;
  all.xSectorSize = sector_bytes;
  all.xDeviceCharacteristics = characteristics;
  return all;
}
constexpr sqlite3_io_methods kMethods = methods();

sqlite3_vfs* system_files() {
  static sqlite3_vfs* const found = sqlite3_vfs_find(nullptr);
  return found;
}

// Files without a descriptor in their URI are temporary ones.
int open(sqlite3_vfs* /*self*/, const char* name, sqlite3_file* file, int flags, int* out_flags) {
  const sqlite3_int64 descriptor = name == nullptr ? -1 : sqlite3_uri_int64(name, "fd", -1);
  if (descriptor < 0) return system_files()->xOpen(system_files(), name, file, flags, out_flags);
  auto* const held = reinterpret_cast<HeldOsFile*>(file);
  held->base.pMethods = &kMethods;
  held->descriptor = static_cast<int>(descriptor);
  if (out_flags != nullptr) *out_flags = flags;
  return SQLITE_OK;
}

}  // namespace

const char* held_file_system() {
  static sqlite3_vfs files = [] {
    sqlite3_vfs copy = *system_files();
    copy.zName = kName;
    copy.pNext = nullptr;
    copy.szOsFile = std::max(copy.szOsFile, static_cast<int>(sizeof(HeldOsFile)));
    copy.xOpen = open;
    return copy;
  }();
  static const int registered = sqlite3_vfs_register(&files, 0);
  return registered == SQLITE_OK ? kName : nullptr;
}

}  // namespace milepost::sqlite
