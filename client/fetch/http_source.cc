#include "client/fetch/http_source.h"

#include <atomic>
#include <functional>
#include <map>
#include <mutex>
#include <set>
#include <utility>

#include "client/cache/tile_cache.h"
#include "client/fetch/cell_request.h"
#include "client/fetch/documents.h"
#include "client/fetch/http_source_parts.h"
#include "client/fetch/nearby.h"
#include "client/fetch/server_requests.h"
#include "client/fetch/tile_fetcher.h"
#include "client/fetch/tile_request.h"
#include "schema/base/digits.h"

namespace milepost {
namespace {

constexpr std::size_t kMaxDocumentsInMemory = 64;
// After the server was unavailable, it is not asked for this time for what the cache knows:
// otherwise a vehicle without a network would wait for a connection timeout at every frame.
constexpr std::int64_t kServerAway_s = 5;

template <class Entry>
using SharedIndex = std::shared_ptr<const std::vector<Entry>>;

bool is_unavailable(const Status& status) {
  return !status.ok() && status.error().code == ErrorCode::unavailable;
}

// Recently read documents of one kind, parsed, by their cache keys. Safe to use from several
// threads at once.
template <class Document>
class DocumentMemory {
 public:
  using Shared = std::shared_ptr<const Document>;

  Shared find(const CacheKey& key) const {
    const std::lock_guard lock(mutex_);
    const auto found = documents_.find(parts_of(key));
    return found == documents_.end() ? nullptr : found->second;
  }

  void keep(const CacheKey& key, Shared document) {
    const std::lock_guard lock(mutex_);
    // The cache on disk has them all, so clearing the memory costs little.
    if (documents_.size() >= kMaxDocumentsInMemory) documents_.clear();
    documents_[parts_of(key)] = std::move(document);
  }

 private:
  static std::array<std::string, 3> parts_of(const CacheKey& key) {
    return {key.map, key.build, key.segment};
  }

  mutable std::mutex mutex_;
  std::map<std::array<std::string, 3>, Shared> documents_;
};

// The lines of the cached segments, built when first needed. Safe to use from several threads at
// once.
class LineMemory {
 public:
  using Lines = std::shared_ptr<const std::vector<KnownLine>>;

  Lines get_or_make(const std::function<std::vector<KnownLine>()>& make) {
    const std::lock_guard lock(mutex_);
    if (lines_ == nullptr) lines_ = std::make_shared<const std::vector<KnownLine>>(make());
    return lines_;
  }

  // Called when the contents of the cache or the most recently used build may have changed.
  void forget() {
    const std::lock_guard lock(mutex_);
    lines_ = nullptr;
  }

 private:
  std::mutex mutex_;
  Lines lines_;
};

// The state shared by all callers of one source.
struct HttpShared {
  HttpShared(std::string url, const HttpSourceSettings& settings, HttpSourceParts parts,
             std::unique_ptr<TileCache> open_cache)
      : base_url(std::move(url)),
        steady_s(std::move(parts.steady_s)),
        cache(std::move(open_cache)),
        requests(std::move(parts.transport),
                 {.attempts = settings.attempts, .sleep = std::move(parts.sleep)}),
        fetcher(requests, *cache) {}

  const std::string base_url;
  const std::function<std::int64_t()> steady_s;
  const std::unique_ptr<TileCache> cache;
  ServerRequests requests;
  TileFetcher fetcher;
  DocumentMemory<MapDescription> maps;
  DocumentMemory<SegmentDocument> segments;
  DocumentMemory<AreasDocument> areas;
  LineMemory known_lines;
  std::atomic<std::int64_t> server_away_until_s = 0;
};

class HttpSource : public MapSource {
 public:
  HttpSource(std::shared_ptr<HttpShared> shared, Stopped stopped, int attempts)
      : shared_(std::move(shared)),
        stopped_(std::move(stopped)),
        retry_(shared_->requests.retry()),
        base_url_(shared_->base_url),
        cache_(*shared_->cache),
        requests_(shared_->requests),
        fetcher_(shared_->fetcher) {
    retry_.attempts = attempts;
  }

  Result<std::vector<NearbySegment>> segments_near(const GeoPoint& position,
                                                   double radius_m) override {
    const Status checked = check_near_query(position, radius_m);
    if (!checked.ok()) return checked.error();
    const std::string url =
        base_url_ + "/v1/segments?near=" + shortest_fixed(position.latitude_deg) + "," +
        shortest_fixed(position.longitude_deg) + "&radius_m=" + shortest_fixed(radius_m);
    const auto parse = [this, &url](const std::string& text) {
      auto segments = parse_nearby_document(text, url);
      if (segments.ok()) shared_->known_lines.forget();
      return segments;
    };
    return current_list<NearbySegment>(
        url, [&] { return segments_known_near(position, radius_m); }, parse);
  }

  Result<std::vector<MapVersion>> maps() override {
    const std::string url = base_url_ + "/v1/maps";
    const auto parse = [&url](const std::string& text) {
      return parse_catalog_document(text, url);
    };
    return current_list<MapVersion>(
        url, [this] { return maps_known(); }, parse);
  }

  Result<MapDescription> describe(const MapVersion& version) override {
    const std::string url = map_url(version);
    const auto parse = [&](std::string_view text,
                           const std::string& where) -> Result<MapDescription> {
      auto described = parse_map_document(text, where, version.map);
      if (described.ok() && described->version != version) {
        return rebuilt(url, version, described->version);
      }
      return described;
    };
    const auto document = document_at(
        shared_->maps, CacheKey::map_document(version.map, version.build), url, parse, [] {});
    if (!document.ok()) return document.error();
    return **document;
  }

  Result<SegmentDescription> segment(const MapVersion& version,
                                     const std::string& segment) override {
    const auto document = document_of(version, segment);
    if (!document.ok()) return document.error();
    return (*document)->description;
  }

  Result<std::vector<EncodedTile>> tiles(const MapVersion& version, const std::string& segment,
                                         const std::string& layer,
                                         const AlongRange& range) override {
    const auto index = index_of(version, segment, layer);
    if (!index.ok()) return index.error();
    const std::vector<TileEntry> wanted = entries_meeting(**index, range);
    // The segment document must not be evicted before its tiles.
    cache_.touch(CacheKey::segment_document(version.map, version.build, segment));
    const std::string tiles_url = segment_url(version, segment) + "/tiles";
    auto found = fetcher_.fetch(
        {version.map, version.build, segment, layer, 0}, expected_tiles(wanted),
        [&](const auto& missing) { return request_for_tiles(tiles_url, layer, **index, missing); },
        stopped_);
    if (!found.ok()) return found.error();
    std::vector<EncodedTile> tiles;
    tiles.reserve(wanted.size());
    for (const TileEntry& entry : wanted) {
      tiles.push_back({entry.index, std::move((*found)[entry.index])});
    }
    return tiles;
  }

  Result<std::vector<EncodedCell>> cells(const MapVersion& version, const std::string& layer,
                                         const Bounds& box) override {
    const Status checked = check_area_query(box);
    if (!checked.ok()) return checked.error();
    const auto index = cell_index_of(version, layer);
    if (!index.ok()) return index.error();
    const std::vector<CellEntry> wanted = entries_meeting(**index, box);
    // The documents that list the cells must not be evicted before them.
    cache_.touch(CacheKey::areas_document(version.map, version.build));
    cache_.touch(CacheKey::map_document(version.map, version.build));
    const std::string layer_url = areas_url(version) + "/" + escaped_for_url(layer);
    auto found = fetcher_.fetch(
        {version.map, version.build, "", layer, 0}, expected_tiles(wanted),
        [&](const auto& missing) { return request_for_cells(layer_url, **index, missing); },
        stopped_);
    if (!found.ok()) return found.error();
    std::vector<EncodedCell> tiles;
    tiles.reserve(wanted.size());
    for (const CellEntry& entry : wanted) {
      tiles.push_back({entry.cell, std::move((*found)[entry.cell])});
    }
    return tiles;
  }

  Result<std::uint64_t> layer_bytes(const MapVersion& version, const std::string& segment,
                                    const std::string& layer) override {
    const auto index = index_of(version, segment, layer);
    if (!index.ok()) return index.error();
    return bytes_of(**index);
  }

  Result<std::vector<TileEntry>> tile_index(const MapVersion& version, const std::string& segment,
                                            const std::string& layer) override {
    const auto index = index_of(version, segment, layer);
    if (!index.ok()) return index.error();
    return **index;
  }

  Result<std::optional<Bytes>> stored_tile(const MapVersion& version, const std::string& segment,
                                           const std::string& layer,
                                           const TileEntry& entry) override {
    return fetcher_.find({version.map, version.build, segment, layer, 0}, expected_tile(entry));
  }

  Attempt fetch_tiles(const MapVersion& version, const std::string& segment,
                      const std::string& layer, const std::vector<TileEntry>& tiles,
                      const TileSink& take) override {
    const auto index = index_of(version, segment, layer);
    if (!index.ok()) return {index.error()};
    // The documents that list the tiles must not be evicted before them.
    cache_.touch(CacheKey::map_document(version.map, version.build));
    cache_.touch(CacheKey::segment_document(version.map, version.build, segment));
    std::set<std::uint32_t> missing;
    for (const TileEntry& entry : **index) {
      if (std::ranges::find(tiles, entry.index, &TileEntry::index) != tiles.end()) {
        missing.insert(entry.index);
      }
    }
    if (missing.empty()) {  // the document has changed since the tiles were selected
      return {Error{ErrorCode::corrupt, segment_url(version, segment),
                    "its tiles are not those that it listed before", "build the map anew"}};
    }
    const std::string tiles_url = segment_url(version, segment) + "/tiles";
    return fetcher_.fetch_once(
        {version.map, version.build, segment, layer, 0},
        request_for_tiles(tiles_url, layer, **index, missing),
        [&](std::uint32_t number, const Bytes& tile) {
          take({number, tile});
          return missing.contains(number);
        },
        stopped_);
  }

  std::shared_ptr<MapSource> until(Stopped stopped, Asking asking) override {
    const int attempts = asking == Asking::once ? 1 : retry_.attempts;
    const auto either = [first = stopped_, second = std::move(stopped)] {
      return is_stopped(first) || is_stopped(second);
    };
    return std::make_shared<HttpSource>(shared_, either, attempts);
  }

  SourceCounters counters() const override {
    return {requests_.made(), requests_.bytes_received(), fetcher_.from_cache(),
            fetcher_.from_server(), cache_.counters().failures};
  }

 private:
  std::string map_url(const MapVersion& version) const {
    return base_url_ + "/v1/maps/" + escaped_for_url(version.map);
  }

  std::string build_url(const MapVersion& version) const {
    return map_url(version) + "/builds/" + escaped_for_url(version.build);
  }

  std::string segment_url(const MapVersion& version, const std::string& segment) const {
    return build_url(version) + "/segments/" + escaped_for_url(segment);
  }

  std::string areas_url(const MapVersion& version) const { return build_url(version) + "/areas"; }

  static CheckedRequest request_for_tiles(const std::string& tiles_url, const std::string& layer,
                                          const std::vector<TileEntry>& index,
                                          const std::set<std::uint32_t>& missing) {
    const TileRequest request = request_for_first_run(index, missing);
    const std::string name = escaped_for_url(layer);
    const std::string url =
        request.range
            ? tiles_url + "?layer=" + name + "&from_m=" + shortest_fixed(request.range->from_m) +
                  "&to_m=" + shortest_fixed(request.range->to_m)
            : tiles_url + "/" + name + "/" + std::to_string(request.expected.front().index);
    return {url, expected_tiles(request.expected)};
  }

  static CheckedRequest request_for_cells(const std::string& layer_url,
                                          const std::vector<CellEntry>& index,
                                          const std::set<std::uint32_t>& missing) {
    const CellRequest request = request_for_first_block(index, missing);
    const std::string url = request.box
                                ? layer_url + "?bbox=" + shortest_fixed(request.box->west_deg) +
                                      "," + shortest_fixed(request.box->south_deg) + "," +
                                      shortest_fixed(request.box->east_deg) + "," +
                                      shortest_fixed(request.box->north_deg)
                                : layer_url + "/" + std::to_string(request.expected.front().cell);
    return {url, expected_tiles(request.expected)};
  }

  static Error rebuilt(const std::string& url, const MapVersion& asked, const MapVersion& current) {
    return {ErrorCode::gone, url,
            "the map was rebuilt: build " + asked.build + " is gone, the current one is " +
                current.build,
            "request the map's current build"};
  }

  Status document(const std::string& url, const DocumentReader& read) {
    return with_retries(retry_, stopped_,
                        [&] { return requests_.try_document(url, read, stopped_); });
  }

  // The server's current list; while the server cannot be reached or something else answers in its
  // place, the list known without it, if not empty.
  template <class Item>
  Result<std::vector<Item>> current_list(
      const std::string& url, const std::function<std::vector<Item>()>& known_items,
      const std::function<Result<std::vector<Item>>(const std::string& text)>& parse) {
    std::vector<Item> items;
    if (shared_->steady_s() < shared_->server_away_until_s) items = known_items();
    if (!items.empty()) return items;
    const auto read = [&](const std::string& text) -> Status {
      Result<std::vector<Item>> parsed = parse(text);
      if (!parsed.ok()) return parsed.error();
      items = std::move(*parsed);
      return ok_status();
    };
    const Status fetched = with_retries(retry_, stopped_, [&] {
      Attempt attempt = requests_.try_document(url, read, stopped_);
      if (is_unavailable(attempt.status)) {
        shared_->server_away_until_s = shared_->steady_s() + kServerAway_s;
        items = known_items();
      }
      return items.empty() ? attempt : Attempt{};
    });
    if (!fetched.ok()) return fetched.error();
    return items;
  }

  std::vector<MapVersion> maps_known() {
    std::vector<MapVersion> maps;
    for (const CachedDocument& cached : cache_.map_documents()) {
      maps.push_back({cached.key.map, cached.key.build});
    }
    return maps;
  }

  std::vector<NearbySegment> segments_known_near(const GeoPoint& position, double radius_m) {
    const auto lines = shared_->known_lines.get_or_make([this] { return cached_lines(); });
    return lines_near(*lines, position, radius_m);
  }

  std::vector<KnownLine> cached_lines() {
    std::vector<KnownLine> lines;
    for (const CachedDocument& cached : cache_.segment_documents()) {
      const MapVersion version{cached.key.map, cached.key.build};
      const auto document =
          parse_segment_document(cached.content, "the cache", version, cached.key.segment);
      if (document.ok()) add_line(version, document->description, lines);
    }
    return lines;
  }

  Result<std::shared_ptr<const SegmentDocument>> document_of(const MapVersion& version,
                                                             const std::string& segment) {
    const auto parse = [&](std::string_view text, const std::string& where) {
      return parse_segment_document(text, where, version, segment);
    };
    return document_at(
        shared_->segments, CacheKey::segment_document(version.map, version.build, segment),
        segment_url(version, segment), parse, [this] { shared_->known_lines.forget(); });
  }

  // An immutable document: from memory, else from the cache, else from the server.
  template <class Document, class Parse, class OnFetched>
  Result<std::shared_ptr<const Document>> document_at(DocumentMemory<Document>& memory,
                                                      const CacheKey& key, const std::string& url,
                                                      const Parse& parse,
                                                      const OnFetched& on_fetched) {
    using Shared = std::shared_ptr<const Document>;
    if (Shared known = memory.find(key)) return known;
    const auto keep = [&](Document&& document) {
      const auto shared = std::make_shared<const Document>(std::move(document));
      memory.keep(key, shared);
      return Shared(shared);
    };
    if (const auto cached = cache_.find(key)) {
      Result<Document> document = parse(as_text(*cached), "the cache");
      if (document.ok()) return keep(std::move(*document));
      cache_.remove(key);
    }
    Shared fetched_document;
    const Status fetched = document(url, [&](const std::string& text) -> Status {
      Result<Document> document = parse(text, url);
      if (!document.ok()) return document.error();
      cache_.store(key, as_bytes(text));
      on_fetched();
      fetched_document = keep(std::move(*document));
      return ok_status();
    });
    if (!fetched.ok()) return fetched.error();
    return fetched_document;
  }

  // The tile index of a layer; empty if the map has the layer but the segment has no tile in it.
  Result<SharedIndex<TileEntry>> index_of(const MapVersion& version, const std::string& segment,
                                          const std::string& layer) {
    const auto document = document_of(version, segment);
    if (!document.ok()) return document.error();
    return index_in(version, *document, (*document)->tiles, layer);
  }

  // The cell index of a layer; empty if the map has the layer but no cell in it.
  Result<SharedIndex<CellEntry>> cell_index_of(const MapVersion& version,
                                               const std::string& layer) {
    const auto parse = [&](std::string_view text, const std::string& where) {
      return parse_areas_document(text, where, version);
    };
    const auto document =
        document_at(shared_->areas, CacheKey::areas_document(version.map, version.build),
                    areas_url(version), parse, [] {});
    if (!document.ok()) return document.error();
    return index_in(version, *document, **document, layer);
  }

  // The index of one layer among those of `document`.
  template <class Document, class Entry>
  Result<SharedIndex<Entry>> index_in(const MapVersion& version,
                                      const std::shared_ptr<const Document>& document,
                                      const std::map<std::string, std::vector<Entry>>& indices,
                                      const std::string& layer) {
    const auto found = indices.find(layer);
    if (found != indices.end()) return SharedIndex<Entry>(document, &found->second);
    const Result<MapDescription> map = describe(version);
    if (!map.ok()) return map.error();
    if (map->layers.contains(layer)) {
      return SharedIndex<Entry>(std::make_shared<const std::vector<Entry>>());
    }
    return Error{ErrorCode::not_found, map_url(version), "the map has no layer \"" + layer + "\"",
                 "build the map with it"};
  }

  const std::shared_ptr<HttpShared> shared_;
  const Stopped stopped_;
  RetryPolicy retry_;
  const std::string& base_url_;
  TileCache& cache_;
  ServerRequests& requests_;
  TileFetcher& fetcher_;
};

}  // namespace

Result<std::shared_ptr<MapSource>> make_http_source(const HttpSourceSettings& settings,
                                                    HttpSourceParts parts) {
  Result<std::string> base_url = checked_server_url(settings.server_url);
  if (!base_url.ok()) return base_url.error();
  auto cache =
      TileCache::open({settings.cache_directory, settings.cache_limit_bytes, parts.steady_s});
  if (!cache.ok()) return cache.error();
  auto shared = std::make_shared<HttpShared>(std::move(base_url).value(), settings,
                                             std::move(parts), std::move(cache).value());
  return std::shared_ptr<MapSource>(
      std::make_shared<HttpSource>(std::move(shared), settings.stopped, settings.attempts));
}

Result<std::shared_ptr<MapSource>> open_http_source(const HttpSourceSettings& settings) {
  HttpSourceParts parts;
  parts.transport = make_curl_transport(
      {settings.connect_timeout_s, settings.stall_timeout_s, settings.least_bytes_per_s});
  parts.sleep = sleep_until_stopped;
  return make_http_source(settings, std::move(parts));
}

}  // namespace milepost
