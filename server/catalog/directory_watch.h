// Tells when files of a directory come, go or are written.
#pragma once

#include <filesystem>
#include <utility>

#include "schema/base/result.h"

namespace milepost::server {

// What happens on other hosts to a directory that is shared with them, and behind symbolic links,
// is not told. Not safe to use from several threads at once.
class DirectoryWatch {
 public:
  // Errors: io (too many are watched, no such directory).
  static Result<DirectoryWatch> open(const std::filesystem::path& directory);

  DirectoryWatch(DirectoryWatch&& other) noexcept
      : descriptor_(std::exchange(other.descriptor_, -1)) {}
  DirectoryWatch& operator=(DirectoryWatch&&) = delete;
  DirectoryWatch(const DirectoryWatch&) = delete;
  ~DirectoryWatch();

  int descriptor() const { return descriptor_; }  // readable when something happened
  // Whether something happened since the last call.
  bool take();

 private:
  explicit DirectoryWatch(int descriptor) : descriptor_(descriptor) {}
  int descriptor_;
};

}  // namespace milepost::server
