#include "server/catalog/map_documents.h"

#include <nlohmann/json.hpp>

#include "schema/document/canonical_json.h"

namespace milepost::server {

std::string current_map_document(const std::string& name, const MapReader& reader) {
  nlohmann::json document = nlohmann::json::parse(reader.map_document());
  document["name"] = name;
  document["build"] = reader.build();
  document["segments"] = reader.segment_ids();
  return canonical_json(document);
}

}  // namespace milepost::server
