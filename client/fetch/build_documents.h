// The documents of builds (FORMAT.md 7), from memory, the cache or the server.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "client/cache/tile_cache.h"
#include "client/fetch/document_memory.h"
#include "client/fetch/documents.h"
#include "client/fetch/retry.h"
#include "client/fetch/server_requests.h"
#include "client/fetch/signed_builds.h"
#include "client/fetch/static_store.h"
#include "schema/document/manifest.h"

namespace milepost {

// How a caller wants the server to be asked.
struct Asker {
  const RetryPolicy& retry;
  const Stopped& stopped;
};

// A build is accepted by its signature first, if there are keys (SignedBuilds). Every document is
// checked against its build before it is parsed or stored: the manifest by the
// build, which is its digest, the others by the manifest. What the cache holds and is not the
// document is removed from it. Safe to use from several threads at once.
class BuildDocuments {
 public:
  template <class Document>
  using Shared = Result<std::shared_ptr<const Document>>;

  // `on_segment_fetched` is called after a segment's document was stored. REQUIRES: all references
  // outlive it.
  BuildDocuments(std::string base_url, ServerRequests& requests, TileCache& cache,
                 const StaticStore& store, std::vector<PublicKey> keys,
                 std::function<void()> on_segment_fetched)
      : base_url_(std::move(base_url)),
        requests_(requests),
        cache_(cache),
        store_(store),
        signed_builds_(std::move(keys), requests, cache),
        on_segment_fetched_(std::move(on_segment_fetched)) {}

  // Errors of all: those of SignedBuilds::check and ServerRequests::try_covered_document; not_found
  // (the build has no such segment); corrupt, also for a document of the build that this client
  // cannot read.
  Shared<MapDescription> map(const MapVersion& version, const Asker& asker);
  Shared<SegmentDocument> segment(const MapVersion& version, const std::string& segment,
                                  const Asker& asker);
  Shared<AreasDocument> areas(const MapVersion& version, const Asker& asker);

  // What the cache holds of each map's most recently used build, without a server.
  std::vector<MapVersion> cached_maps();
  using CachedSegment = std::pair<MapVersion, SegmentDescription>;
  std::vector<CachedSegment> cached_segments();

  // Marks as used what leads to the tiles of a segment, or to the cells.
  void touch_segment(const MapVersion& version, const std::string& segment);
  void touch_areas(const MapVersion& version);

  std::string build_url(const MapVersion& version) const;
  std::string segment_url(const MapVersion& version, const std::string& segment) const;
  std::string areas_url(const MapVersion& version) const;

 private:
  template <class Document>
  struct Wanted;

  Shared<Manifest> manifest(const MapVersion& version, const Asker& asker);
  std::shared_ptr<const Manifest> cached_manifest(const MapVersion& version);
  template <class Document>
  Shared<Document> read(const Wanted<Document>& wanted, const Asker& asker, bool& fetched);

  const std::string base_url_;
  ServerRequests& requests_;
  TileCache& cache_;
  const StaticStore& store_;
  SignedBuilds signed_builds_;
  const std::function<void()> on_segment_fetched_;
  DocumentMemory<Manifest> manifests_;
  DocumentMemory<MapDescription> maps_;
  DocumentMemory<SegmentDocument> segments_;
  DocumentMemory<AreasDocument> areas_;
};

}  // namespace milepost
