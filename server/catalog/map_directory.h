// What a directory of maps holds: which of its files are served under which names, and which are
// left out.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "schema/base/result.h"
#include "server/catalog/directory_watch.h"
#include "server/catalog/map_build.h"
#include "server/catalog/open_maps.h"

namespace milepost::server {

using Warn = std::function<void(const std::string& line)>;

// One file, as it was found.
struct LookedAt {
  FileIdentity identity;
  bool is_no_map = false;                 // nor named as one
  std::string name;                       // of the map; empty: it has none
  std::shared_ptr<const MapBuild> build;  // if it was read and is sound
  std::optional<Error> fault;             // why it is not served, or is none
};

struct MapDirectory {
  std::map<std::string, LookedAt> files;                          // that are not hidden, by path
  std::map<std::string, std::shared_ptr<const MapBuild>> maps;    // by name
  std::vector<std::pair<std::filesystem::path, Error>> left_out;  // maps, or named so
};

// What is kept of all maps, whether they are asked for or not.
struct KeptLimits {
  std::size_t held_files = 256;  // open; others are opened when they are asked for
  std::uint64_t line_bytes =
      64U << 20U;  // of lines, about; others are read when they are asked for
};

// Reads the directory. Files that did not change since `before` are not read again, and where
// `changes` tells of all that happened since, no others are looked at; new ones are read by several
// threads. Of files with the same map name the one that ends in ".map" is served,
// or none. `warn` is told of files that are no maps, those of `before` aside. Errors: not_found or
// io (directory).
Result<MapDirectory> read_directory(const std::filesystem::path& directory,
                                    const MapDirectory& before, const DirectoryChanges& changes,
                                    OpenMaps& open_maps, const KeptLimits& limits,
                                    const Warn& warn);

}  // namespace milepost::server
