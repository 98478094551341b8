// The folder that `milepost-server publish` writes, file by file (PROTOCOL.md 6).
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "schema/base/result.h"

namespace milepost::server {

// A file appears complete, under its final name, or not at all; one that has the content already is
// not touched. Files that are not part of a tree are left alone. One process at a time has it open.
class StaticTree {
 public:
  // Lists the tree's files, with their headers; the sign that a folder is such a tree.
  static constexpr const char* kHeadersFile = "headers.json";

  // Opens a tree; an absent or empty folder becomes one, with `first_headers` as the content of
  // kHeadersFile. Errors: invalid_input (a folder with other content, or no folder), unavailable
  // (another process has it open), io.
  static Result<StaticTree> open(const std::filesystem::path& folder,
                                 const std::string& first_headers);

  StaticTree(StaticTree&& other) noexcept;
  StaticTree& operator=(StaticTree&&) = delete;
  ~StaticTree();

  // `path` is relative to the folder. Errors: io (a full disk, a folder in the way).
  Status write(const std::string& path, std::string_view content);
  // After it, what was written is on the disk. Errors: io.
  Status sync() const;
  // The names of a folder's entries, in order; none if there is no such folder.
  std::vector<std::string> names_in(const std::string& path) const;
  // Removes a file, or a folder with all its content. Errors: io.
  Status remove(const std::string& path);

  const std::filesystem::path& folder() const { return folder_; }
  std::size_t files() const { return files_; }      // passed to write()
  std::size_t written() const { return written_; }  // of them, those that were not there

 private:
  StaticTree(std::filesystem::path folder, int descriptor)
      : folder_(std::move(folder)), descriptor_(descriptor) {}
  Status prepare(const std::string& first_headers);
  Status replace(const std::filesystem::path& file, std::string_view content);

  std::filesystem::path folder_;
  int descriptor_;  // of the folder, locked; -1 once moved from
  std::size_t files_ = 0;
  std::size_t written_ = 0;
};

}  // namespace milepost::server
