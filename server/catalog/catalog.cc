#include "server/catalog/catalog.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <string_view>
#include <system_error>
#include <vector>

#include <nlohmann/json.hpp>

#include "schema/base/ids.h"
#include "schema/store/map_content.h"

namespace milepost::server {
namespace fs = std::filesystem;
namespace {

// A map is a SQLite file that carries the application id of map.sql, big-endian at byte 68
// (https://www.sqlite.org/fileformat.html, section 1.3).
constexpr std::string_view kSqliteMagic("SQLite format 3\0", 16);
constexpr std::size_t kApplicationIdAt = 68;

bool is_map_file(const fs::path& file) {
  std::array<char, kApplicationIdAt + 4> head{};
  std::ifstream stream(file, std::ios::binary);
  stream.read(head.data(), head.size());
  if (!stream || !std::string_view(head.data(), head.size()).starts_with(kSqliteMagic))
    return false;
  std::int64_t application_id = 0;
  for (std::size_t i = kApplicationIdAt; i < head.size(); ++i) {
    application_id = application_id * 256 + static_cast<unsigned char>(head[i]);
  }
  return application_id == kMapApplicationId;
}

// The regular files of a directory that are not hidden, by name.
Result<std::vector<fs::path>> files_of(const fs::path& directory) {
  std::error_code error;
  std::vector<fs::path> files;
  fs::directory_iterator entry(directory, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    std::error_code ignored;  // a file that vanishes meanwhile is not there
    const bool hidden = entry->path().filename().string().starts_with('.');
    if (!hidden && entry->is_regular_file(ignored)) files.push_back(entry->path());
  }
  if (error == std::errc::no_such_file_or_directory) {
    return Error{ErrorCode::not_found, directory.string(), "there is no such directory",
                 "name the directory of the map files"};
  }
  if (error) {
    return Error{ErrorCode::io, directory.string(), "cannot be listed (" + error.message() + ")",
                 "name a readable directory of map files"};
  }
  std::sort(files.begin(), files.end());
  return files;
}

Document catalog_document(const std::map<std::string, std::shared_ptr<const ServedMap>>& maps) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const auto& [name, map] : maps) list.push_back({{"name", name}, {"build", map->build()}});
  const nlohmann::ordered_json json = {{"maps", std::move(list)}};
  return document_of(json.dump());
}

}  // namespace

Result<std::shared_ptr<const Catalog>> Catalog::open(const fs::path& directory, unsigned readers,
                                                     const Warn& warn) {
  const Result<std::vector<fs::path>> files = files_of(directory);
  if (!files) return files.error();
  const std::shared_ptr<Catalog> catalog(new Catalog);
  for (const fs::path& file : *files) {
    if (!is_map_file(file)) {
      warn(file.string() + ": is no milepost map and is skipped; move it elsewhere");
      continue;
    }
    const Status added = catalog->add(file, readers);
    if (!added) return added.error();
  }
  catalog->document_ = catalog_document(catalog->maps_);
  return std::shared_ptr<const Catalog>(catalog);
}

Status Catalog::add(const fs::path& file, unsigned readers) {
  const std::string name = file.stem().string();
  if (!is_segment_id(name)) {
    return Error{ErrorCode::invalid_input, file.string(),
                 "the map's name '" + name + "' cannot stand in a URL",
                 "rename the file with 1 to 64 of A-Z a-z 0-9 . _ -"};
  }
  if (const auto other = files_.find(name); other != files_.end()) {
    return Error{ErrorCode::invalid_input, file.string(),
                 "has the same map name '" + name + "' as " + other->second.string(),
                 "rename or remove one of the two"};
  }
  Result<std::shared_ptr<const ServedMap>> map = ServedMap::open(name, file, readers);
  if (!map) return map.error();
  maps_[name] = std::move(*map);
  files_[name] = file;
  return ok_status();
}

}  // namespace milepost::server
