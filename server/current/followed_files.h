// Files that are read again when they change.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "schema/base/result.h"

namespace milepost::server {

// look() is for one thread at a time; the counts are for any.
class FollowedFiles {
 public:
  // The files have been read already. `load` reads them and replaces what was read before; its
  // error is told to the log, and what was read before stays.
  FollowedFiles(std::vector<std::filesystem::path> files, std::function<Status()> load);

  // Loads if a file is another one, or was written to, since the last look.
  void look();
  std::uint64_t loads() const { return loads_; }
  std::uint64_t failures() const { return failures_; }

 private:
  using Identity = std::array<std::int64_t, 5>;  // of a file and its content; 0 if absent
  std::vector<Identity> identities() const;

  const std::vector<std::filesystem::path> files_;
  const std::function<Status()> load_;
  std::vector<Identity> known_;
  std::atomic<std::uint64_t> loads_{0};
  std::atomic<std::uint64_t> failures_{0};
};

}  // namespace milepost::server
