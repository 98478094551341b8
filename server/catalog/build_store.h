// Takes up new map files and older builds in a directory that may be served meanwhile.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "schema/base/result.h"

namespace milepost::server {

// A build that is kept beside the directory's maps (kept_builds.h).
struct KeptBuild {
  std::string build;
  std::filesystem::path file;
};

// The directory has whole maps at every instant: files take each other's places by renaming. One
// process at a time writes. Not safe to use from several threads at once.
class BuildStore {
 public:
  explicit BuildStore(std::filesystem::path directory) : directory_(std::move(directory)) {}

  // The builds of a map that were current once, the latest first.
  std::vector<KeptBuild> kept(const std::string& map) const;

  // Copies a map file, checks every byte of the copy, keeps the build before it, of which `keep`
  // stay, and makes the copy the map's file. With the signature beside it, if there is one. Returns
  // the build. Errors: those of MapReader::open and verify; invalid_input (no name for a map; the
  // build is the current one already); io.
  Result<std::string> install(const std::filesystem::path& file, std::size_t keep);

  // Makes a kept build the current one again, the latest if `build` is empty, and keeps the one
  // that it takes the place of. Returns the build. Errors: not_found (no such build), corrupt, io.
  Result<std::string> roll_back(const std::string& map, const std::string& build);

 private:
  std::filesystem::path current_file(const std::string& map) const;
  Status keep_current(const std::string& map);
  void forget(const std::string& map, std::size_t keep) const;

  std::filesystem::path directory_;
};

}  // namespace milepost::server
