// The maps of a directory, as requests see them.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "server/catalog/served_map.h"

namespace milepost::server {

// Immutable, so safe to share between threads.
class Catalog {
 public:
  using Warn = std::function<void(const std::string& line)>;

  // Opens every map among the directory's files that are regular and not hidden; a map's name is
  // the stem of its file. A file that is no map is skipped, with a line for `warn`.
  // Errors: not_found or io (directory), invalid_input (two maps of one name, a name that cannot
  // stand in a URL), and those of ServedMap::open: a map that cannot be served is never left out
  // silently.
  static Result<std::shared_ptr<const Catalog>> open(const std::filesystem::path& directory,
                                                     unsigned readers, const Warn& warn);

  const std::map<std::string, std::shared_ptr<const ServedMap>>& maps() const { return maps_; }
  const Document& document() const { return document_; }  // of GET /v1/maps

 private:
  Catalog() = default;
  Status add(const std::filesystem::path& file, unsigned readers);

  std::map<std::string, std::shared_ptr<const ServedMap>> maps_;
  std::map<std::string, std::filesystem::path> files_;
  Document document_;
};

}  // namespace milepost::server
