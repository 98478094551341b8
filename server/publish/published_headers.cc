#include "server/publish/published_headers.h"

#include "schema/base/json.h"

namespace milepost::server {
namespace {

constexpr const char* kJsonType = "application/json";
constexpr const char* kForever = "public, max-age=31536000, immutable";
constexpr const char* kRevalidated = "no-cache";

}  // namespace

const std::vector<HeaderGroup>& header_groups() {
  static const std::vector<HeaderGroup> groups = {
      {"tiles",
       {"/v1/maps/*/builds/*/segments/*/tiles/*/*", "/v1/maps/*/builds/*/areas/*/*"},
       "application/octet-stream",
       kForever},
      {"documents",
       {"/v1/maps/*/builds/*/manifest", "/v1/maps/*/builds/*/map", "/v1/maps/*/builds/*/mapping",
        "/v1/maps/*/builds/*/areas/index.json", "/v1/maps/*/builds/*/segments/*/index.json"},
       kJsonType,
       kForever},
      {"signatures",
       {"/v1/maps/*/builds/*/manifest.sig"},
       "text/plain; charset=utf-8",
       kRevalidated},
      {"current",
       {"/v1/maps/*/index.json", "/v1/segments", "/v1/maps/index.json"},
       kJsonType,
       kRevalidated}};
  return groups;
}

std::string headers_document(const EntityTags& files) {
  nlohmann::ordered_json groups = nlohmann::ordered_json::array();
  for (const HeaderGroup& group : header_groups()) {
    groups.push_back({{"name", group.name},
                      {"patterns", group.patterns},
                      {"Content-Type", group.content_type},
                      {"Cache-Control", group.cache_control}});
  }
  nlohmann::ordered_json tags = nlohmann::ordered_json::object();
  for (const auto& [path, tag] : files) tags[path] = '"' + tag + '"';
  const nlohmann::ordered_json document = {{"groups", std::move(groups)},
                                           {"ETag", std::move(tags)}};
  return document.dump(1) + '\n';
}

Result<EntityTags> entity_tags_in(std::string_view document) {
  const Error wrong{ErrorCode::corrupt, "", "does not list the files of a published tree",
                    "remove the folder and publish anew"};
  const auto json = nlohmann::json::parse(document, nullptr, false);
  if (!json.is_object() || !json.contains("ETag") || !json["ETag"].is_object()) return wrong;
  EntityTags files;
  for (const auto& [path, tag] : json["ETag"].items()) {
    if (!tag.is_string() || tag.get_ref<const std::string&>().size() < 2) return wrong;
    const auto& quoted = tag.get_ref<const std::string&>();
    files[path] = quoted.substr(1, quoted.size() - 2);
  }
  return files;
}

}  // namespace milepost::server
