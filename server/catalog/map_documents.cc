#include "server/catalog/map_documents.h"

#include <nlohmann/json.hpp>

#include "schema/document/canonical_json.h"

namespace milepost::server {

std::string current_map_document(const std::string& name, const std::string& build,
                                 const std::string& map_document,
                                 const std::vector<std::string>& segments) {
  nlohmann::json document = nlohmann::json::parse(map_document);
  document["name"] = name;
  document["build"] = build;
  document["segments"] = segments;
  return canonical_json(document);
}

}  // namespace milepost::server
