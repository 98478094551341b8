// Where older builds of a directory's maps are kept: DIRECTORY/.builds/MAP/BUILD.map.
#pragma once

#include <filesystem>
#include <string>

namespace milepost::server {

inline std::filesystem::path kept_builds_folder(const std::filesystem::path& directory,
                                                const std::string& map) {
  return directory / ".builds" / map;
}

inline std::filesystem::path kept_build_file(const std::filesystem::path& directory,
                                             const std::string& map, const std::string& build) {
  return kept_builds_folder(directory, map) / (build + ".map");
}

}  // namespace milepost::server
