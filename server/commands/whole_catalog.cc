#include "server/commands/whole_catalog.h"

namespace milepost::server {

Result<std::shared_ptr<const Catalog>> open_whole_catalog(const std::string& directory) {
  std::string left_out;  // the last line: maps that are left out follow other files
  auto catalog = Catalog::open(directory, CatalogSettings(),
                               [&](const std::string& line) { left_out = line; });
  if (!catalog) return catalog.error();
  if ((*catalog)->left_out() > 0) return Error{ErrorCode::invalid_input, "", left_out, ""};
  if (!(*catalog)->maps().empty()) return catalog;
  return Error{ErrorCode::not_found, directory, "holds no map", "give the directory of the maps"};
}

}  // namespace milepost::server
