#include "client/fetch/http_source.h"

#include <atomic>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <utility>

#include "client/cache/tile_cache.h"
#include "client/fetch/build_documents.h"
#include "client/fetch/cell_request.h"
#include "client/fetch/documents.h"
#include "client/fetch/http_source_parts.h"
#include "client/fetch/nearby.h"
#include "client/fetch/server_requests.h"
#include "client/fetch/static_store.h"
#include "client/fetch/tile_fetcher.h"
#include "client/fetch/tile_request.h"
#include "schema/base/digits.h"

namespace milepost {
namespace {

// After the server was unavailable, it is not asked for this time for what the cache knows:
// otherwise a vehicle without a network would wait for a connection timeout at every frame.
constexpr std::int64_t kServerAway_s = 5;

template <class Entry>
using SharedIndex = std::shared_ptr<const std::vector<Entry>>;

bool is_unavailable(const Status& status) {
  return !status.ok() && status.error().code == ErrorCode::unavailable;
}

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
        fetcher(requests, *cache),
        documents(base_url, requests, *cache, store, settings.keys,
                  [this] { known_lines.forget(); }) {}

  const std::string base_url;
  const std::function<std::int64_t()> steady_s;
  const std::unique_ptr<TileCache> cache;
  ServerRequests requests;
  TileFetcher fetcher;
  StaticStore store;
  BuildDocuments documents;
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
        fetcher_(shared_->fetcher),
        documents_(shared_->documents),
        store_(shared_->store) {
    retry_.attempts = attempts;
  }

  Result<std::vector<NearbySegment>> segments_near(const GeoPoint& position,
                                                   double radius_m) override {
    const Status checked = check_near_query(position, radius_m);
    if (!checked.ok()) return checked.error();
    if (const auto listed = store_.segments_at(shared_->steady_s())) {
      return near_among(*listed, position, radius_m);
    }
    const std::string url =
        base_url_ + "/v1/segments?near=" + shortest_fixed(position.latitude_deg) + "," +
        shortest_fixed(position.longitude_deg) + "&radius_m=" + shortest_fixed(radius_m);
    StaticStore::Segments listed;  // by a static store, which does not look at the position
    const auto parse = [&](const std::string& text) -> Result<std::vector<NearbySegment>> {
      if (is_of_static_store(text)) {
        auto segments = parse_placed_segments(text, url);
        if (!segments.ok()) return segments.error();
        listed = std::make_shared<const std::vector<PlacedSegment>>(std::move(*segments));
        store_.note(true);
        store_.list(listed, shared_->steady_s());
        return std::vector<NearbySegment>();
      }
      auto segments = parse_nearby_document(text, url);
      if (!segments.ok()) return segments;
      store_.note(false);
      shared_->known_lines.forget();
      return segments;
    };
    auto near = current_list<NearbySegment>(
        {url}, [&] { return segments_known_near(position, radius_m); }, parse);
    if (listed == nullptr) return near;
    return near_among(*listed, position, radius_m);
  }

  Result<std::vector<MapVersion>> maps() override {
    const std::string url = base_url_ + "/v1/maps";
    const auto parse = [&](const std::string& text) {
      auto maps = parse_catalog_document(text, url);
      if (maps.ok()) store_.note(is_of_static_store(text));
      return maps;
    };
    // A plain web server answers for a folder as it likes.
    return current_list<MapVersion>(
        {url, StaticStore::index_url(url)}, [this] { return documents_.cached_maps(); }, parse);
  }

  Result<MapDescription> describe(const MapVersion& version) override {
    const auto document = documents_.map(version, asker());
    if (!document.ok()) return document.error();
    return **document;
  }

  Result<SegmentDescription> segment(const MapVersion& version,
                                     const std::string& segment) override {
    const auto document = documents_.segment(version, segment, asker());
    if (!document.ok()) return document.error();
    return (*document)->description;
  }

  Result<std::vector<EncodedTile>> tiles(const MapVersion& version, const std::string& segment,
                                         const std::string& layer,
                                         const AlongRange& range) override {
    const auto index = index_of(version, segment, layer);
    if (!index.ok()) return index.error();
    const std::vector<TileEntry> wanted = entries_meeting(**index, range);
    documents_.touch_segment(version, segment);  // not evicted before the tiles that they list
    const std::string tiles_url = documents_.segment_url(version, segment) + "/tiles";
    auto found = fetcher_.fetch(
        {version.map, version.build, segment, layer, 0}, expected_tiles(wanted),
        [&](const auto& missing) {
          return request_for_tiles(tiles_url, layer, **index, askable(missing));
        },
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
    documents_.touch_areas(version);  // not evicted before the cells that they list
    const std::string layer_url = documents_.areas_url(version) + "/" + escaped_for_url(layer);
    auto found = fetcher_.fetch(
        {version.map, version.build, "", layer, 0}, expected_tiles(wanted),
        [&](const auto& missing) {
          return request_for_cells(layer_url, **index, askable(missing));
        },
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
    documents_.touch_segment(version, segment);  // not evicted before the tiles that they list
    std::set<std::uint32_t> missing;
    for (const TileEntry& entry : **index) {
      if (std::ranges::find(tiles, entry.index, &TileEntry::index) != tiles.end()) {
        missing.insert(entry.index);
      }
    }
    if (missing.empty()) {  // the document has changed since the tiles were selected
      return {Error{ErrorCode::corrupt, documents_.segment_url(version, segment),
                    "its tiles are not those that it listed before", "build the map anew"}};
    }
    const std::string tiles_url = documents_.segment_url(version, segment) + "/tiles";
    return fetcher_.fetch_once(
        {version.map, version.build, segment, layer, 0},
        request_for_tiles(tiles_url, layer, **index, askable(missing)),
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
  Asker asker() const { return {retry_, stopped_}; }

  // Of missing tiles those that one request may be for: a static store answers no query, so that
  // each is requested by its own URL.
  std::set<std::uint32_t> askable(const std::set<std::uint32_t>& missing) const {
    return store_.is_known() ? std::set<std::uint32_t>{*missing.begin()} : missing;
  }

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

  // The server's current list, from the first of the URLs at which a milepost server or a static
  // store answers; while the server cannot be reached or something else answers in its place, the
  // list known without it, if not empty.
  template <class Item>
  Result<std::vector<Item>> current_list(
      const std::vector<std::string>& urls, const std::function<std::vector<Item>()>& known_items,
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
      Attempt attempt = requests_.try_document(urls.front(), read, stopped_);
      for (std::size_t i = 1; i < urls.size() && attempt.is_foreign; ++i) {
        if (const Attempt other = requests_.try_document(urls[i], read, stopped_); other.status) {
          attempt = other;
        }
      }
      if (is_unavailable(attempt.status)) {
        shared_->server_away_until_s = shared_->steady_s() + kServerAway_s;
        items = known_items();
      }
      return items.empty() ? attempt : Attempt{};
    });
    if (!fetched.ok()) return fetched.error();
    return items;
  }

  // The segments of a static store near a position, by their documents. Those whose documents
  // cannot be used are left out, but where there are no others they are the error.
  Result<std::vector<NearbySegment>> near_among(const std::vector<PlacedSegment>& listed,
                                                const GeoPoint& position, double radius_m) {
    std::vector<KnownLine> lines;
    std::optional<Error> unusable;
    for (const PlacedSegment& placed : listed) {
      if (!may_be_within(placed.bounds, position, radius_m)) continue;
      const Result<SegmentDescription> described = segment(placed.version, placed.segment);
      if (described.ok()) {
        add_line(placed.version, *described, lines);
        continue;
      }
      const ErrorCode code = described.error().code;
      if (code == ErrorCode::unavailable || code == ErrorCode::cancelled) return described.error();
      unusable = described.error();
    }
    std::vector<NearbySegment> near = lines_near(lines, position, radius_m);
    if (near.empty() && unusable) return *unusable;
    return near;
  }

  std::vector<NearbySegment> segments_known_near(const GeoPoint& position, double radius_m) {
    const auto lines = shared_->known_lines.get_or_make([this] { return cached_lines(); });
    return lines_near(*lines, position, radius_m);
  }

  std::vector<KnownLine> cached_lines() {
    std::vector<KnownLine> lines;
    for (const auto& [version, segment] : documents_.cached_segments()) {
      add_line(version, segment, lines);
    }
    return lines;
  }

  // The tile index of a layer; empty if the map has the layer but the segment has no tile in it.
  Result<SharedIndex<TileEntry>> index_of(const MapVersion& version, const std::string& segment,
                                          const std::string& layer) {
    const auto document = documents_.segment(version, segment, asker());
    if (!document.ok()) return document.error();
    return index_in(version, *document, (*document)->tiles, layer);
  }

  // The cell index of a layer; empty if the map has the layer but no cell in it.
  Result<SharedIndex<CellEntry>> cell_index_of(const MapVersion& version,
                                               const std::string& layer) {
    const auto document = documents_.areas(version, asker());
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
    return Error{ErrorCode::not_found, documents_.build_url(version),
                 "the map has no layer \"" + layer + "\"", "build the map with it"};
  }

  const std::shared_ptr<HttpShared> shared_;
  const Stopped stopped_;
  RetryPolicy retry_;
  const std::string& base_url_;
  TileCache& cache_;
  ServerRequests& requests_;
  TileFetcher& fetcher_;
  BuildDocuments& documents_;
  StaticStore& store_;
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
  parts.transport =
      make_curl_transport({settings.connect_timeout_s, settings.stall_timeout_s,
                           settings.least_bytes_per_s, settings.ca_file, settings.token});
  parts.sleep = sleep_until_stopped;
  return make_http_source(settings, std::move(parts));
}

}  // namespace milepost
