// Routes to the prepared documents of the catalog.
#include <map>

#include "server/routes/answers.h"
#include "server/routes/lookup.h"
#include "server/routes/routes.h"

namespace milepost::server {

Result<Response> answer_maps(const Call& call) {
  if (call.grant.is_for_everything()) return current_json(call.catalog.document());
  auto maps = call.catalog.maps();
  std::erase_if(maps, [&](const auto& map) { return !call.grant.is_for(map.first); });
  return current_json(catalog_document(maps));
}

Result<Response> answer_map(const Call& call) {
  const Result<std::shared_ptr<const ServedMap>> map = find_map(call.catalog, call.path[0]);
  if (!map) return map.error();
  return current_json((*map)->document());
}

Result<Response> answer_manifest(const Call& call) {
  const Result<std::shared_ptr<const ServedMap>> map =
      find_build(call.catalog, call.path[0], call.path[1]);
  if (!map) return map.error();
  return immutable_json((*map)->manifest());
}

// Not immutable, as all else of a build is: a map may be signed later, or with another key.
Result<Response> answer_signature(const Call& call) {
  const Result<std::shared_ptr<const ServedMap>> map =
      find_build(call.catalog, call.path[0], call.path[1]);
  if (!map) return map.error();
  Result<std::string> signature = call.catalog.signature(**map);
  if (!signature) return signature.error();
  return current_text(document_of(std::move(*signature)), "text/plain; charset=utf-8");
}

Result<Response> answer_summary(const Call& call) {
  const Result<std::shared_ptr<const ServedMap>> map =
      find_build(call.catalog, call.path[0], call.path[1]);
  if (!map) return map.error();
  return immutable_json((*map)->summary());
}

Result<Response> answer_mapping(const Call& call) {
  const Result<std::shared_ptr<const ServedMap>> map =
      find_build(call.catalog, call.path[0], call.path[1]);
  if (!map) return map.error();
  Result<std::string> mapping = (*map)->mapping();
  if (!mapping) return mapping.error();
  if (mapping->empty()) {
    return Error{ErrorCode::not_found, "the record of the mapping of map '" + call.path[0] + "'",
                 "does not exist", "build the map anew to have one"};
  }
  return immutable_json(document_of(std::move(*mapping)));
}

Result<Response> answer_segment(const Call& call) {
  const Result<std::shared_ptr<const ServedMap>> map =
      find_build(call.catalog, call.path[0], call.path[1]);
  if (!map) return map.error();
  const Result<const ServedSegment*> segment = find_segment(**map, call.path[2]);
  if (!segment) return segment.error();
  return immutable_json((*segment)->document);
}

Result<Response> answer_areas(const Call& call) {
  const Result<std::shared_ptr<const ServedMap>> map =
      find_build(call.catalog, call.path[0], call.path[1]);
  if (!map) return map.error();
  return immutable_json((*map)->areas());
}

}  // namespace milepost::server
