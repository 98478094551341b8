#include "schema/document/manifest.h"

#include "schema/base/digest.h"
#include "schema/base/ids.h"
#include "schema/base/json.h"
#include "schema/document/canonical_json.h"

namespace milepost {
namespace {

using nlohmann::json;

Error no_manifest(const std::string& what) {
  return {ErrorCode::corrupt, "", "the manifest: " + what, "build the map anew"};
}

json listed_json(const ListedDocument& document) {
  return {{"bytes", document.bytes}, {"digest", document.digest}};
}

// None if `object` does not list a document.
std::optional<ListedDocument> listed_in(const json& object) {
  if (!object.is_object()) return std::nullopt;
  const auto bytes = object.find("bytes");
  const auto digest = object.find("digest");
  const bool typed = bytes != object.end() && bytes->is_number_unsigned() &&
                     digest != object.end() && digest->is_string();
  if (!typed) return std::nullopt;
  ListedDocument listed{bytes->get<std::uint64_t>(), digest->get<std::string>()};
  const bool sound =
      listed.bytes > 0 && listed.bytes <= kMaxDocumentBytes && is_digest(listed.digest);
  return sound ? std::optional(std::move(listed)) : std::nullopt;
}

// Adds a member of `segments`.
Status add_segment(const json& object, Manifest& manifest) {
  const std::optional<ListedDocument> listed = listed_in(object);
  const auto id = listed ? object.find("segment") : object.end();
  const bool named = listed && id != object.end() && id->is_string() &&
                     is_segment_id(id->get_ref<const std::string&>());
  if (!named) return no_manifest("a member of \"segments\" is not a segment with bytes and digest");
  const auto& name = id->get_ref<const std::string&>();
  const bool ascending = manifest.segments.empty() || manifest.segments.rbegin()->first < name;
  if (!ascending) return no_manifest("the segments are not ascending");
  manifest.segments.emplace_hint(manifest.segments.end(), name, *listed);
  return ok_status();
}

}  // namespace

ListedDocument ListedDocument::of(std::string_view text) {
  return {text.size(), digest_of(as_bytes(text))};
}

bool ListedDocument::is(std::string_view text) const {
  return text.size() == bytes && digest_of(as_bytes(text)) == digest;
}

std::string manifest_document(const Manifest& manifest) {
  json segments = json::array();
  for (const auto& [id, document] : manifest.segments) {
    segments.push_back(listed_json(document));
    segments.back()["segment"] = id;
  }
  json document = {{"format", kMapFormat},
                   {"map", listed_json(manifest.map)},
                   {"areas", listed_json(manifest.areas)},
                   {"segments", std::move(segments)}};
  if (manifest.mapping) document["mapping"] = listed_json(*manifest.mapping);
  return canonical_json(document);
}

Result<Manifest> manifest_from(std::string_view text) {
  const Result<json> object = read_json(text);
  if (!object) return no_manifest(object.error().what);
  if (!object->is_object()) return no_manifest("it is not a JSON object");
  if (object->value("format", json()) != kMapFormat) {
    return no_manifest("its format is not " + std::to_string(kMapFormat));
  }
  const auto map = listed_in(object->value("map", json()));
  const auto areas = listed_in(object->value("areas", json()));
  if (!map || !areas) return no_manifest(R"("map" or "areas" is not bytes and a digest)");
  Manifest manifest{*map, *areas};
  if (const auto mapping = object->find("mapping"); mapping != object->end()) {
    manifest.mapping = listed_in(*mapping);
    if (!manifest.mapping) return no_manifest(R"("mapping" is not bytes and a digest)");
  }
  const json segments = object->value("segments", json());
  if (!segments.is_array()) return no_manifest("\"segments\" is not a list");
  for (const json& segment : segments) {
    if (Status added = add_segment(segment, manifest); !added) return added.error();
  }
  return manifest;
}

}  // namespace milepost
