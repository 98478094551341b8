// Tells when files of a directory come, go or are written.
#pragma once

#include <filesystem>
#include <set>
#include <utility>

#include "schema/base/result.h"

namespace milepost::server {

// What happened to a directory.
struct DirectoryChanges {
  std::set<std::filesystem::path> files;  // that came, went, were written or took another's place
  bool may_be_more = false;               // than these files: look at all
};

// What happens on other hosts to a directory that is shared with them, and behind symbolic links,
// is not told. Not safe to use from several threads at once.
class DirectoryWatch {
 public:
  // Errors: io (too many are watched, no such directory).
  static Result<DirectoryWatch> open(const std::filesystem::path& directory);

  DirectoryWatch(DirectoryWatch&& other) noexcept
      : directory_(std::move(other.directory_)),
        descriptor_(std::exchange(other.descriptor_, -1)) {}
  DirectoryWatch& operator=(DirectoryWatch&&) = delete;
  DirectoryWatch(const DirectoryWatch&) = delete;
  ~DirectoryWatch();

  int descriptor() const { return descriptor_; }  // readable when something happened
  // Adds what happened since the last call. Returns whether anything did.
  bool take(DirectoryChanges& changes);

 private:
  DirectoryWatch(std::filesystem::path directory, int descriptor)
      : directory_(std::move(directory)), descriptor_(descriptor) {}
  std::filesystem::path directory_;
  int descriptor_;
};

}  // namespace milepost::server
