// The maps of a directory, for the handling of requests.
#pragma once

#include <cstddef>
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

  // Opens every map among the directory's files that are not hidden; a map's name is the stem of
  // its file (map_file.h). Files that cannot be served are skipped with a message to `warn`. Of
  // files with the same map name the one that ends in ".map" is served, or none. Errors: not_found
  // or io (directory); if there are maps and none can be served, the reason.
  static Result<std::shared_ptr<const Catalog>> open(const std::filesystem::path& directory,
                                                     unsigned readers, const Warn& warn);

  const std::map<std::string, std::shared_ptr<const ServedMap>>& maps() const { return maps_; }
  const Document& document() const { return document_; }  // of GET /v1/maps
  // Files that hold a map, or are named ".map", but are not served.
  std::size_t left_out() const { return left_out_; }

 private:
  Catalog() = default;

  std::map<std::string, std::shared_ptr<const ServedMap>> maps_;
  std::size_t left_out_ = 0;
  Document document_;
};

}  // namespace milepost::server
