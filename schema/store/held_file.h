// A file that is held open for reading: its bytes stay the same after it was replaced by renaming,
// moved or deleted.
#pragma once

#include <cstdint>
#include <filesystem>
#include <utility>

#include "schema/base/result.h"

namespace milepost {

// Which file it is and which state of it: another file under the same name, or another content,
// differ in it.
struct FileIdentity {
  std::uint64_t device = 0;
  std::uint64_t inode = 0;
  std::uint64_t bytes = 0;
  std::int64_t modified_ns = 0;  // since 1970
  std::int64_t changed_ns = 0;   // of the inode: its name, its permissions or its content

  bool is_same_file(const FileIdentity& other) const {
    return device == other.device && inode == other.inode;
  }
  friend bool operator==(const FileIdentity&, const FileIdentity&) = default;
};

// Of the file that a path leads to now. Errors: not_found, io.
Result<FileIdentity> identity_of(const std::filesystem::path& file);

// Safe to use from several threads at once.
class HeldFile {
 public:
  // Does not wait for a FIFO's writer. Errors: not_found, io.
  static Result<HeldFile> open(const std::filesystem::path& file);

  HeldFile(HeldFile&& other) noexcept
      : path_(std::move(other.path_)),
        descriptor_(std::exchange(other.descriptor_, -1)),
        identity_(other.identity_) {}
  HeldFile& operator=(HeldFile&&) = delete;
  HeldFile(const HeldFile&) = delete;
  ~HeldFile();

  const std::filesystem::path& path() const { return path_; }  // where it was opened
  int descriptor() const { return descriptor_; }
  const FileIdentity& identity() const { return identity_; }  // when it was opened

 private:
  HeldFile(std::filesystem::path path, int descriptor)
      : path_(std::move(path)), descriptor_(descriptor) {}

  std::filesystem::path path_;
  int descriptor_;
  FileIdentity identity_;
};

}  // namespace milepost
