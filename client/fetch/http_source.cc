#include "client/fetch/http_source.h"

#include <array>
#include <atomic>
#include <charconv>
#include <chrono>
#include <functional>
#include <map>
#include <mutex>
#include <set>
#include <thread>
#include <utility>

#include "client/cache/tile_cache.h"
#include "client/fetch/documents.h"
#include "client/fetch/frame_cutter.h"
#include "client/fetch/http_source_parts.h"
#include "client/fetch/nearby.h"
#include "client/fetch/retry.h"
#include "client/fetch/tile_request.h"

namespace milepost {
namespace {

constexpr std::uint64_t kMaxDocumentBytes = 64ULL << 20U;
constexpr std::size_t kMaxDocumentsInMemory = 64;
// For so long after it was unavailable, the server is not asked what the cache knows: a vehicle
// without a network would wait for the connection to time out at every frame.
constexpr std::int64_t kServerAway_s = 5;

using SharedDocument = std::shared_ptr<const SegmentDocument>;
using SharedIndex = std::shared_ptr<const std::vector<TileEntry>>;

// The shortest digits that read back as the same number; never an exponent, whose + is a space in
// a URL.
std::string digits_of(double number) {
  std::array<char, 512> buffer{};
  const auto written =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), number, std::chars_format::fixed);
  return {buffer.data(), written.ptr};
}

bool is_unavailable(const Status& status) {
  return !status.ok() && status.error().code == ErrorCode::unavailable;
}

// The segment documents read lately, parsed. Safe to use from several threads at once.
class DocumentMemory {
 public:
  SharedDocument find(const MapVersion& version, const std::string& segment) const {
    const std::lock_guard lock(mutex_);
    const auto found = documents_.find({version.map, version.build, segment});
    return found == documents_.end() ? nullptr : found->second;
  }

  void keep(const MapVersion& version, const std::string& segment, SharedDocument document) {
    const std::lock_guard lock(mutex_);
    // The cache on disk has them all, so that starting afresh costs little.
    if (documents_.size() >= kMaxDocumentsInMemory) documents_.clear();
    documents_[{version.map, version.build, segment}] = std::move(document);
  }

 private:
  mutable std::mutex mutex_;
  std::map<std::array<std::string, 3>, SharedDocument> documents_;
};

// The lines of the cached segments, made when they are first needed. Safe to use from several
// threads at once.
class LineMemory {
 public:
  using Lines = std::shared_ptr<const std::vector<KnownLine>>;

  Lines get_or_make(const std::function<std::vector<KnownLine>()>& make) {
    const std::lock_guard lock(mutex_);
    if (lines_ == nullptr) lines_ = std::make_shared<const std::vector<KnownLine>>(make());
    return lines_;
  }

  // What the cache holds, or which build was used last, may have changed.
  void forget() {
    const std::lock_guard lock(mutex_);
    lines_ = nullptr;
  }

 private:
  std::mutex mutex_;
  Lines lines_;
};

// The tiles of one layer of one segment that a call collects.
struct TileCollection {
  std::string segment_url;
  CacheKey key;  // of the layer's tiles, but for the number
  SharedIndex index;
  std::set<std::uint32_t> missing;
  std::map<std::uint32_t, Bytes> frames;
};

// Two threads that miss the same tile at the same time may both ask for it.
class HttpSource : public MapSource {
 public:
  HttpSource(std::string base_url, const HttpSourceSettings& settings, HttpSourceParts parts,
             std::unique_ptr<TileCache> cache)
      : base_url_(std::move(base_url)),
        now_s_(std::move(parts.now_s)),
        transport_(std::move(parts.transport)),
        cache_(std::move(cache)) {
    retry_.attempts = settings.attempts;
    retry_.sleep = std::move(parts.sleep);
  }

  Result<std::vector<NearbySegment>> segments_near(const GeoPoint& position,
                                                   double radius_m) override {
    const Status checked = check_near_query(position, radius_m);
    if (!checked.ok()) return checked.error();
    const std::string url = base_url_ + "/v1/segments?near=" + digits_of(position.latitude_deg) +
                            "," + digits_of(position.longitude_deg) +
                            "&radius_m=" + digits_of(radius_m);
    std::vector<NearbySegment> known;
    if (now_s_() < server_away_until_s_) known = segments_known_near(position, radius_m);
    if (!known.empty()) return known;
    std::string text;
    const Status fetched = with_retries(retry_, [&] {
      Attempt attempt = fetch_text(url, text);
      if (is_unavailable(attempt.status)) {
        server_away_until_s_ = now_s_() + kServerAway_s;
        known = segments_known_near(position, radius_m);
      }
      return known.empty() ? attempt : Attempt{};
    });
    if (!known.empty()) return known;
    if (!fetched.ok()) return fetched.error();
    known_lines_.forget();
    return parse_nearby_document(text, url);
  }

  Result<MapDescription> describe(const MapVersion& version) override {
    const CacheKey key = CacheKey::map_document(version.map, version.build);
    const std::string url = map_url(version);
    if (const auto cached = cache_->find(key)) {
      auto known = parse_map_document(as_text(*cached), url, version.map);
      if (known.ok() && known->version == version) return known;
      cache_->remove(key);
    }
    const Result<std::string> text = fetch_document(url);
    if (!text.ok()) return text.error();
    auto description = parse_map_document(*text, url, version.map);
    if (!description.ok()) return description;
    if (description->version != version) return rebuilt(url, version, description->version);
    cache_->store(key, as_bytes(*text));
    return description;
  }

  Result<SegmentDescription> segment(const MapVersion& version,
                                     const std::string& segment) override {
    const Result<SharedDocument> document = document_of(version, segment);
    if (!document.ok()) return document.error();
    return (*document)->description;
  }

  Result<std::vector<TileFrame>> tiles(const MapVersion& version, const std::string& segment,
                                       const std::string& layer, const AlongRange& range) override {
    const Result<SharedIndex> index = index_of(version, segment, layer);
    if (!index.ok()) return index.error();
    TileCollection collection{segment_url(version, segment),
                              {version.map, version.build, segment, layer, 0},
                              *index,
                              {},
                              {}};
    const std::vector<TileEntry> wanted = entries_meeting(**index, range);
    take_from_cache(wanted, collection);
    // Its document must not be forgotten before its tiles are.
    cache_->touch(CacheKey::segment_document(version.map, version.build, segment));
    const Status fetched = fetch_missing(collection);
    if (!fetched.ok()) return fetched.error();
    std::vector<TileFrame> frames;
    frames.reserve(wanted.size());
    for (const TileEntry& entry : wanted) {
      frames.push_back({entry.index, std::move(collection.frames[entry.index])});
    }
    return frames;
  }

  Result<std::uint64_t> layer_bytes(const MapVersion& version, const std::string& segment,
                                    const std::string& layer) override {
    const Result<SharedIndex> index = index_of(version, segment, layer);
    if (!index.ok()) return index.error();
    return bytes_of(**index);
  }

  SourceCounters counters() const override {
    return {requests_, bytes_received_, tiles_from_cache_, tiles_fetched_,
            cache_->counters().failures};
  }

 private:
  std::string map_url(const MapVersion& version) const {
    return base_url_ + "/v1/maps/" + escaped_for_url(version.map);
  }

  std::string segment_url(const MapVersion& version, const std::string& segment) const {
    return map_url(version) + "/builds/" + escaped_for_url(version.build) + "/segments/" +
           escaped_for_url(segment);
  }

  static std::string tile_url(const TileCollection& collection, const TileRequest& request) {
    const std::string layer = escaped_for_url(collection.key.layer);
    const std::string tiles_url = collection.segment_url + "/tiles";
    if (!request.range.has_value()) {
      return tiles_url + "/" + layer + "/" + std::to_string(request.expected.front().index);
    }
    return tiles_url + "?layer=" + layer + "&from_m=" + digits_of(request.range->from_m) +
           "&to_m=" + digits_of(request.range->to_m);
  }

  static Error rebuilt(const std::string& url, const MapVersion& asked, const MapVersion& current) {
    return {ErrorCode::gone, url,
            "the map was rebuilt: build " + asked.build + " is gone, the current one is " +
                current.build,
            "ask for the map's current build"};
  }

  HttpAnswer get(const std::string& url, std::uint64_t limit_bytes, const BodySink& sink) {
    ++requests_;
    HttpAnswer answer = transport_->get(url, limit_bytes, sink);
    bytes_received_ += answer.body_bytes;
    return answer;
  }

  Attempt fetch_text(const std::string& url, std::string& text) {
    text.clear();
    HttpAnswer answer = get(url, kMaxDocumentBytes, [&](ByteView piece) {
      text += as_text(piece);
      return ok_status();
    });
    return {std::move(answer.status), answer.retry_after_s};
  }

  Result<std::string> fetch_document(const std::string& url) {
    std::string text;
    const Status fetched = with_retries(retry_, [&] { return fetch_text(url, text); });
    if (!fetched.ok()) return fetched.error();
    return text;
  }

  std::vector<NearbySegment> segments_known_near(const GeoPoint& position, double radius_m) {
    const auto lines = known_lines_.get_or_make([this] { return cached_lines(); });
    return lines_near(*lines, position, radius_m);
  }

  std::vector<KnownLine> cached_lines() {
    std::vector<KnownLine> lines;
    for (const CachedDocument& cached : cache_->segment_documents()) {
      const MapVersion version{cached.key.map, cached.key.build};
      const auto document =
          parse_segment_document(cached.content, "the cache", version, cached.key.segment);
      if (document.ok()) add_line(version, document->description, lines);
    }
    return lines;
  }

  Result<SharedDocument> document_of(const MapVersion& version, const std::string& segment) {
    if (SharedDocument known = memory_.find(version, segment)) return known;
    auto document = cached_document(version, segment);
    if (document == nullptr) {
      auto fetched = fetched_document(version, segment);
      if (!fetched.ok()) return fetched;
      document = std::move(fetched).value();
    }
    memory_.keep(version, segment, document);
    return document;
  }

  SharedDocument cached_document(const MapVersion& version, const std::string& segment) {
    const CacheKey key = CacheKey::segment_document(version.map, version.build, segment);
    const auto text = cache_->find(key);
    if (!text.has_value()) return nullptr;
    auto document = parse_segment_document(as_text(*text), "the cache", version, segment);
    if (document.ok()) return std::make_shared<const SegmentDocument>(std::move(*document));
    cache_->remove(key);
    return nullptr;
  }

  Result<SharedDocument> fetched_document(const MapVersion& version, const std::string& segment) {
    const std::string url = segment_url(version, segment);
    const Result<std::string> text = fetch_document(url);
    if (!text.ok()) return text.error();
    auto document = parse_segment_document(*text, url, version, segment);
    if (!document.ok()) return document.error();
    cache_->store(CacheKey::segment_document(version.map, version.build, segment), as_bytes(*text));
    known_lines_.forget();
    return SharedDocument(std::make_shared<const SegmentDocument>(std::move(*document)));
  }

  // The tile index of a layer; empty if the map has the layer and the segment nothing in it.
  Result<SharedIndex> index_of(const MapVersion& version, const std::string& segment,
                               const std::string& layer) {
    const Result<SharedDocument> document = document_of(version, segment);
    if (!document.ok()) return document.error();
    const auto found = (*document)->tiles.find(layer);
    if (found != (*document)->tiles.end()) return SharedIndex(*document, &found->second);
    const Result<MapDescription> map = describe(version);
    if (!map.ok()) return map.error();
    if (map->layers.contains(layer)) {
      return SharedIndex(std::make_shared<const std::vector<TileEntry>>());
    }
    return Error{ErrorCode::not_found, map_url(version), "the map has no layer \"" + layer + "\"",
                 "build the map with it"};
  }

  // What the cache lacks becomes `missing`.
  void take_from_cache(const std::vector<TileEntry>& wanted, TileCollection& collection) {
    for (const TileEntry& entry : wanted) {
      CacheKey key = collection.key;
      key.number = entry.index;
      if (auto frame = cache_->find(key, entry.digest)) {
        collection.frames[entry.index] = std::move(*frame);
        ++tiles_from_cache_;
      } else {
        collection.missing.insert(entry.index);
      }
    }
  }

  Status fetch_missing(TileCollection& collection) {
    while (!collection.missing.empty()) {
      Status fetched = with_retries(retry_, [&] { return fetch_first_run(collection); });
      if (!fetched.ok()) return fetched;
    }
    return ok_status();
  }

  Attempt fetch_first_run(TileCollection& collection) {
    const TileRequest request = request_for_first_run(*collection.index, collection.missing);
    const std::string url = tile_url(collection, request);
    const std::size_t missing_before = collection.missing.size();
    FrameCutter cutter(url, request.expected, [&](const TileEntry& entry, Bytes frame) {
      take_from_server(entry, std::move(frame), collection);
    });
    HttpAnswer answer =
        get(url, bytes_of(request.expected), [&](ByteView piece) { return cutter.take(piece); });
    if (answer.status.ok()) return {cutter.finish()};
    // Whole tiles of an answer that broke off are kept, and the next request asks for the rest.
    const bool advanced = collection.missing.size() < missing_before;
    if (advanced && is_unavailable(answer.status)) return {};
    return {std::move(answer.status), answer.retry_after_s};
  }

  void take_from_server(const TileEntry& entry, Bytes frame, TileCollection& collection) {
    ++tiles_fetched_;
    CacheKey key = collection.key;
    key.number = entry.index;
    cache_->store(key, frame);
    collection.missing.erase(entry.index);
    collection.frames[entry.index] = std::move(frame);
  }

  const std::string base_url_;
  const std::function<std::int64_t()> now_s_;
  const std::unique_ptr<Transport> transport_;
  const std::unique_ptr<TileCache> cache_;
  RetryPolicy retry_;
  DocumentMemory memory_;
  LineMemory known_lines_;
  std::atomic<std::int64_t> server_away_until_s_ = 0;
  std::atomic<std::uint64_t> requests_ = 0;
  std::atomic<std::uint64_t> bytes_received_ = 0;
  std::atomic<std::uint64_t> tiles_from_cache_ = 0;
  std::atomic<std::uint64_t> tiles_fetched_ = 0;
};

}  // namespace

Result<std::unique_ptr<MapSource>> make_http_source(const HttpSourceSettings& settings,
                                                    HttpSourceParts parts) {
  Result<std::string> base_url = checked_server_url(settings.server_url);
  if (!base_url.ok()) return base_url.error();
  auto cache = TileCache::open({settings.cache_directory, settings.cache_limit_bytes, parts.now_s});
  if (!cache.ok()) return cache.error();
  return std::unique_ptr<MapSource>(std::make_unique<HttpSource>(
      std::move(base_url).value(), settings, std::move(parts), std::move(cache).value()));
}

Result<std::unique_ptr<MapSource>> open_http_source(const HttpSourceSettings& settings) {
  HttpSourceParts parts;
  parts.transport = make_curl_transport({settings.connect_timeout_s, settings.stall_timeout_s});
  parts.sleep = [](double pause_s) {
    std::this_thread::sleep_for(std::chrono::duration<double>(pause_s));
  };
  parts.now_s = [] {
    const auto since_1970 = std::chrono::system_clock::now().time_since_epoch();
    return std::int64_t{std::chrono::duration_cast<std::chrono::seconds>(since_1970).count()};
  };
  return make_http_source(settings, std::move(parts));
}

}  // namespace milepost
