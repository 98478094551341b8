#include "client/fetch/build_documents.h"

#include "client/fetch/transport.h"
#include "schema/base/digest.h"

namespace milepost {
namespace {

Result<Manifest> parse_manifest(std::string_view text, const std::string& where) {
  Result<Manifest> manifest = manifest_from(text);
  if (manifest) return manifest;
  Error error = manifest.error();
  error.where = where;
  return error;
}

// The document has its digest, but is not what this client expects.
Error unreadable(Error error, const std::string& url) {
  error.where = url;
  error.hint = "build the map anew, with the same version of milepost as the client's";
  return error;
}

}  // namespace

// A document, how it is recognized, and how it is read.
template <class Document>
struct BuildDocuments::Wanted {
  DocumentMemory<Document>& memory;
  CacheKey key;
  std::string url;
  std::uint64_t limit_bytes = 0;
  std::string digest;
  std::function<Result<Document>(std::string_view text, const std::string& where)> parse;
};

template <class Document>
BuildDocuments::Shared<Document> BuildDocuments::read(const Wanted<Document>& wanted,
                                                      const Asker& asker, bool& fetched) {
  const auto take = [&](std::string_view text) -> Shared<Document> {
    Result<Document> document = wanted.parse(text, wanted.url);
    if (!document) return unreadable(document.error(), wanted.url);
    auto shared = std::make_shared<const Document>(std::move(*document));
    wanted.memory.keep(wanted.key, shared);
    return std::shared_ptr<const Document>(std::move(shared));
  };
  if (auto known = wanted.memory.find(wanted.key)) return known;
  if (const auto cached = cache_.find(wanted.key, wanted.digest)) return take(as_text(*cached));
  const ServerRequests::CoveredDocument document{
      wanted.url, wanted.limit_bytes,
      [&](const std::string& text) { return digest_of(as_bytes(text)) == wanted.digest; },
      [&](const std::string& text) -> Status {
        // Damage that leaves the length is recognized even where the text can no longer be read.
        if (text.size() == wanted.limit_bytes) return ok_status();
        const Result<Document> parsed = wanted.parse(text, wanted.url);
        return parsed ? ok_status() : Status(parsed.error());
      }};
  std::string text;
  const Status asked = with_retries(asker.retry, asker.stopped, [&] {
    auto answer = requests_.try_covered_document(document, asker.stopped);
    text = std::move(answer.text);
    return std::move(answer.attempt);
  });
  if (!asked.ok()) return asked.error();
  cache_.store(wanted.key, as_bytes(text));
  fetched = true;
  return take(text);
}

BuildDocuments::Shared<Manifest> BuildDocuments::manifest(const MapVersion& version,
                                                          const Asker& asker) {
  const Status accepted = signed_builds_.check(version, build_url(version) + "/manifest.sig",
                                               asker.retry, asker.stopped);
  if (!accepted) return accepted.error();
  bool fetched = false;
  return read<Manifest>(
      {manifests_, CacheKey::manifest(version.map, version.build), build_url(version) + "/manifest",
       kMaxDocumentBytes, version.build, parse_manifest},
      asker, fetched);
}

BuildDocuments::Shared<MapDescription> BuildDocuments::map(const MapVersion& version,
                                                           const Asker& asker) {
  const auto of_build = manifest(version, asker);
  if (!of_build) return of_build.error();
  const ListedDocument& listed = (*of_build)->map;
  const auto parse = [&](std::string_view text, const std::string& where) {
    return parse_map_document(text, where, version);
  };
  bool fetched = false;
  return read<MapDescription>({maps_, CacheKey::map_document(version.map, version.build),
                               build_url(version) + "/map", listed.bytes, listed.digest, parse},
                              asker, fetched);
}

BuildDocuments::Shared<SegmentDocument> BuildDocuments::segment(const MapVersion& version,
                                                                const std::string& segment,
                                                                const Asker& asker) {
  const auto of_build = manifest(version, asker);
  if (!of_build) return of_build.error();
  const auto listed = (*of_build)->segments.find(segment);
  if (listed == (*of_build)->segments.end()) {
    return Error{ErrorCode::not_found, segment_url(version, segment),
                 "the build does not have this segment", ""};
  }
  const auto parse = [&](std::string_view text, const std::string& where) {
    return parse_segment_document(text, where, version, segment);
  };
  bool fetched = false;
  auto document = read<SegmentDocument>(
      {segments_, CacheKey::segment_document(version.map, version.build, segment),
       store_.document_url(segment_url(version, segment)), listed->second.bytes,
       listed->second.digest, parse},
      asker, fetched);
  if (fetched) on_segment_fetched_();
  return document;
}

BuildDocuments::Shared<AreasDocument> BuildDocuments::areas(const MapVersion& version,
                                                            const Asker& asker) {
  const auto of_build = manifest(version, asker);
  if (!of_build) return of_build.error();
  const ListedDocument& listed = (*of_build)->areas;
  bool fetched = false;
  return read<AreasDocument>(
      {areas_, CacheKey::areas_document(version.map, version.build),
       store_.document_url(areas_url(version)), listed.bytes, listed.digest, parse_areas_document},
      asker, fetched);
}

// Null if neither memory nor the cache has it, or it is not accepted.
std::shared_ptr<const Manifest> BuildDocuments::cached_manifest(const MapVersion& version) {
  if (!signed_builds_.check_cached(version)) return nullptr;
  const CacheKey key = CacheKey::manifest(version.map, version.build);
  if (auto known = manifests_.find(key)) return known;
  const auto cached = cache_.find(key, version.build);
  if (!cached) return nullptr;
  Result<Manifest> parsed = manifest_from(as_text(*cached));
  if (!parsed) return nullptr;
  auto manifest = std::make_shared<const Manifest>(std::move(*parsed));
  manifests_.keep(key, manifest);
  return manifest;
}

std::vector<MapVersion> BuildDocuments::cached_maps() {
  std::vector<MapVersion> maps;
  for (const CachedDocument& cached : cache_.map_documents()) {
    MapVersion version{cached.key.map, cached.key.build};
    const auto of_build = cached_manifest(version);
    if (of_build && of_build->map.is(cached.content)) maps.push_back(std::move(version));
  }
  return maps;
}

std::vector<BuildDocuments::CachedSegment> BuildDocuments::cached_segments() {
  std::vector<CachedSegment> segments;
  for (const CachedDocument& cached : cache_.segment_documents()) {
    MapVersion version{cached.key.map, cached.key.build};
    const auto of_build = cached_manifest(version);
    if (!of_build) continue;
    const auto listed = of_build->segments.find(cached.key.segment);
    if (listed == of_build->segments.end() || !listed->second.is(cached.content)) continue;
    auto document =
        parse_segment_document(cached.content, "the cache", version, cached.key.segment);
    if (document) segments.emplace_back(std::move(version), std::move(document->description));
  }
  return segments;
}

void BuildDocuments::touch_segment(const MapVersion& version, const std::string& segment) {
  cache_.touch(CacheKey::signature(version.map, version.build));
  cache_.touch(CacheKey::manifest(version.map, version.build));
  cache_.touch(CacheKey::map_document(version.map, version.build));
  cache_.touch(CacheKey::segment_document(version.map, version.build, segment));
}

void BuildDocuments::touch_areas(const MapVersion& version) {
  cache_.touch(CacheKey::signature(version.map, version.build));
  cache_.touch(CacheKey::manifest(version.map, version.build));
  cache_.touch(CacheKey::areas_document(version.map, version.build));
  cache_.touch(CacheKey::map_document(version.map, version.build));
}

std::string BuildDocuments::build_url(const MapVersion& version) const {
  return base_url_ + "/v1/maps/" + escaped_for_url(version.map) + "/builds/" +
         escaped_for_url(version.build);
}

std::string BuildDocuments::segment_url(const MapVersion& version,
                                        const std::string& segment) const {
  return build_url(version) + "/segments/" + escaped_for_url(segment);
}

std::string BuildDocuments::areas_url(const MapVersion& version) const {
  return build_url(version) + "/areas";
}

}  // namespace milepost
