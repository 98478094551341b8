#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <span>
#include <utility>

#include "schema/base/digest.h"
#include "schema/document/manifest.h"
#include "schema/document/map_documents.h"
#include "schema/store/map_checks.h"
#include "schema/store/map_content.h"
#include "schema/store/map_rows.h"
#include "schema/store/map_store.h"
#include "schema/store/map_verification.h"
#include "schema/store/sqlite.h"

namespace milepost {
namespace fs = std::filesystem;
namespace {

// A map is untrusted: nothing in its schema may run code, and damaged cells are rejected. Tiles are
// read once, so that many pages in memory would serve nobody.
constexpr const char* kReadSettings =
    "PRAGMA trusted_schema = OFF; PRAGMA cell_size_check = ON; PRAGMA cache_size = -256;";
constexpr std::size_t kMaxSegmentsInMemory = 64;

enum Query { kTileFrame, kCellFrame };
constexpr const char* kMeta = "SELECT value FROM meta WHERE key = ?";
constexpr const char* kQueries[] = {
    "SELECT frames.frame FROM tiles JOIN frames ON frames.id = tiles.frame "
    "WHERE segment = ? AND layer = ? AND number = ?",
    "SELECT frames.frame FROM cells JOIN frames ON frames.id = cells.frame "
    "WHERE layer = ? AND number = ?",
};
// Of what the queries above need, all that the index of tiles and cells does not: they are prepared
// when the first tile is read.
constexpr std::pair<const char*, const char*> kColumnsOfFrames[] = {
    {"frames", "id"}, {"frames", "frame"}, {"tiles", "frame"}, {"cells", "frame"}};

// Whether the file is a map of this format's version.
Status check_format(const sqlite::Database& map) {
  const Result<std::int64_t> application = map.integer("PRAGMA application_id");
  if (!application) return application.error();
  if (*application != kMapApplicationId) {
    return corrupt(map.file().string(), "this is not a milepost map");
  }
  const Result<std::int64_t> version = map.integer("PRAGMA user_version");
  if (!version) return version.error();
  if (*version == kMapFormatVersion) return ok_status();
  return Error{ErrorCode::corrupt, map.file().string(),
               "this is a map of format version " + std::to_string(*version) + ", not " +
                   std::to_string(kMapFormatVersion),
               *version < kMapFormatVersion
                   ? "build the map anew"
                   : "read it with a newer version of milepost, or build the map anew"};
}

// The entries of one layer in the indices of tiles or cells, without a copy.
template <class Entry>
std::span<const Entry> entries_of(const std::map<std::string, std::vector<Entry>>& indices,
                                  const std::string& layer) {
  const auto index = indices.find(layer);
  if (index == indices.end()) return {};
  return index->second;
}

template <class Entry>
Result<std::vector<Entry>> copied(const Result<std::span<const Entry>>& entries) {
  if (!entries) return entries.error();
  return std::vector<Entry>(entries->begin(), entries->end());
}

// A segment whose document is the manifest's.
struct CheckedSegment {
  SegmentContent content;
  std::string document;
};
using SharedSegment = std::shared_ptr<const CheckedSegment>;

}  // namespace

struct MapReader::Impl {
  sqlite::Database database;
  std::optional<sqlite::Statement> meta{};                    // destroyed before its connection,
  std::array<std::optional<sqlite::Statement>, 2> queries{};  // like all of these; once asked for
  std::optional<MapContent> content{};
  std::string build{};
  std::string manifest_document{};
  Manifest manifest{};
  MapSummary summary{};
  std::string map_document{};
  std::vector<std::string> segment_ids{};
  std::map<std::string, SharedSegment> segments{};  // the latest that were read
  std::optional<CellIndices> cells{};               // once they were read

  std::string place() const { return database.file().string(); }

  Status prepare() {
    Result<sqlite::Statement> of_meta = database.prepare(kMeta);
    if (!of_meta) return of_meta.error();
    meta.emplace(std::move(*of_meta));
    for (const auto& [table, column] : kColumnsOfFrames) {
      if (Status there = database.check_column(table, column); !there) return there;
    }
    Result<MapContent> tables = MapContent::of(database);
    if (!tables) return tables.error();
    content.emplace(std::move(*tables));
    return ok_status();
  }

  // Passes the value of `key` in the table meta to `use`. Returns whether there is one.
  template <class Use>
  Result<bool> read_meta_if_any(const char* key, Use use) {
    Rows row(meta->bind(1, std::string_view(key)));
    const Result<bool> found = row.next();
    if (found && *found) use(row);
    return found;
  }

  template <class Use>
  Status read_meta(const char* key, Use use) {
    const Result<bool> found = read_meta_if_any(key, use);
    if (!found) return found.error();
    if (!*found) return corrupt(place(), std::string("the map lacks its ") + key);
    return ok_status();
  }

  Status read_text_if_any(const char* key, std::string& value) {
    const auto found = read_meta_if_any(key, [&](const Rows& row) { value = row->text(0); });
    return found ? ok_status() : Status(found.error());
  }

  Status read_number(const char* key, double& value) {
    return read_meta(key, [&](const Rows& row) { value = row->real(0); });
  }

  Status read_text(const char* key, std::string& value) {
    return read_meta(key, [&](const Rows& row) { value = row->text(0); });
  }

  Status read_bounds() {
    Bounds& bounds = summary.bounds;
    Status status = read_number("west_deg", bounds.west_deg);
    if (status.ok()) status = read_number("south_deg", bounds.south_deg);
    if (status.ok()) status = read_number("east_deg", bounds.east_deg);
    if (status.ok()) status = read_number("north_deg", bounds.north_deg);
    const bool is_box = std::abs(bounds.west_deg) <= 180 && std::abs(bounds.east_deg) <= 180 &&
                        std::abs(bounds.south_deg) <= 90 && std::abs(bounds.north_deg) <= 90;
    if (status.ok() && !is_box) status = corrupt(place(), "the map's bounds are not in degrees");
    return status;
  }

  Status read_manifest() {
    Status status = read_text("build", build);
    if (status.ok() && !is_digest(build)) {
      status = corrupt(place(), "the map's build is not a digest");
    }
    if (status.ok()) status = read_text("manifest", manifest_document);
    if (!status.ok()) return status;
    if (digest_of(as_bytes(manifest_document)) != build) {
      return corrupt(place(), "the manifest is not that of build " + build);
    }
    Result<Manifest> parsed = manifest_from(manifest_document);
    if (!parsed) return corrupt(place(), parsed.error().what);
    manifest = std::move(*parsed);
    return ok_status();
  }

  Status read_summary() {
    Result<MapSummary> read = content->summary(segment_ids);
    if (!read) return read.error();
    summary = std::move(*read);
    Status status = read_text("feature", summary.feature_json);
    if (status.ok()) status = read_text_if_any("datum", summary.datum);
    if (status.ok()) status = read_bounds();
    if (!status.ok()) return status;
    Result<std::string> document = milepost::map_document(summary);
    if (!document) return corrupt(place() + ", " + document.error().where, document.error().what);
    map_document = std::move(*document);
    return ok_status();
  }

  Status check_summary() const {
    if (!manifest.map.is(map_document)) {
      return corrupt(
          place(),
          "its layers, parameters, bounds, datum or lengths are not those of build " + build);
    }
    const bool same_segments = std::ranges::equal(segment_ids, manifest.segments, {}, {},
                                                  [](const auto& listed) { return listed.first; });
    return same_segments ? ok_status()
                         : Status(corrupt(place(), "its segments are not those of build " + build));
  }

  Error no_segment(const std::string& id) const {
    return {ErrorCode::not_found, place(), "the map has no segment " + id, ""};
  }

  Status require_layer(const std::string& layer) const {
    if (summary.layers.contains(layer)) return ok_status();
    return Error{ErrorCode::not_found, place(), "the map has no layer " + layer, ""};
  }

  Result<SharedSegment> segment(const std::string& id) {
    const auto known = segments.find(id);
    if (known != segments.end()) return known->second;
    const auto listed = manifest.segments.find(id);
    if (listed == manifest.segments.end()) return no_segment(id);
    Result<SegmentContent> read = content->segment(id);
    if (!read) return read.error();
    auto checked = std::make_shared<CheckedSegment>(CheckedSegment{std::move(*read), {}});
    checked->document = checked->content.document();
    if (!listed->second.is(checked->document)) {
      return corrupt(place() + ", segment " + id,
                     "its line, links, passes or tile index are not those of build " + build);
    }
    if (segments.size() >= kMaxSegmentsInMemory) segments.clear();
    segments[id] = checked;
    return SharedSegment(std::move(checked));
  }

  // The view is valid until another segment is read.
  Result<std::span<const TileEntry>> tiles(const std::string& id, const std::string& layer) {
    const Result<SharedSegment> found = segment(id);
    if (!found) return found.error();
    if (Status there = require_layer(layer); !there) return there.error();
    return entries_of((*found)->content.tiles, layer);
  }

  Result<std::span<const CellEntry>> cells_of(const std::string& layer) {
    if (Status there = require_layer(layer); !there) return there.error();
    if (Status read = read_cells(); !read) return read.error();
    return entries_of(*cells, layer);
  }

  Status read_cells() {
    if (cells) return ok_status();
    Result<CellIndices> read = content->cells();
    if (!read) return read.error();
    if (!manifest.areas.is(milepost::areas_document(*read))) {
      return corrupt(place(), "the index of its cells is not that of build " + build);
    }
    cells = std::move(*read);
    return ok_status();
  }

  // The bytes of a tile or a cell, in the first row of a query that `bind` gives its parameters.
  template <class Bind>
  Result<Bytes> frame(Query kind, Bind bind, const std::string& digest, const std::string& where) {
    std::optional<sqlite::Statement>& query = queries.at(kind);
    if (!query) {
      Result<sqlite::Statement> prepared = database.prepare(kQueries[kind]);
      if (!prepared) return prepared.error();
      query.emplace(std::move(*prepared));
    }
    Rows row(bind(*query));
    const Result<bool> found = row.next();
    if (!found) return found.error();
    if (!*found) return corrupt(where, "the tile's bytes are missing");
    const ByteView bytes = row->blob(0);
    if (digest_of(bytes) != digest) {
      return corrupt(where, "the tile's bytes do not match its digest");
    }
    return Bytes(bytes.begin(), bytes.end());
  }
};

MapReader::MapReader(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
MapReader::MapReader(MapReader&&) noexcept = default;
MapReader& MapReader::operator=(MapReader&&) noexcept = default;
MapReader::~MapReader() = default;

Result<MapReader> MapReader::open(const fs::path& file) {
  return of(sqlite::Database::open(file, sqlite::Access::immutable));
}

Result<MapReader> MapReader::open(const HeldFile& file) { return of(sqlite::Database::open(file)); }

Result<MapReader> MapReader::of(Result<sqlite::Database> database) {
  if (!database) return database.error();
  Status status = check_format(*database);
  if (status.ok()) status = database->execute(kReadSettings);
  if (!status.ok()) return status.error();
  auto impl = std::make_unique<Impl>(Impl{std::move(*database)});
  status = impl->prepare();
  if (status.ok()) status = impl->read_summary();
  if (status.ok()) status = impl->read_manifest();
  if (status.ok()) status = impl->check_summary();
  if (!status.ok()) return status.error();
  return MapReader(std::move(impl));
}

const fs::path& MapReader::file() const { return impl_->database.file(); }
const std::string& MapReader::build() const { return impl_->build; }
const std::string& MapReader::feature_json() const { return impl_->summary.feature_json; }
const Bounds& MapReader::bounds() const { return impl_->summary.bounds; }
const std::string& MapReader::datum() const { return impl_->summary.datum; }
const std::map<std::string, std::string>& MapReader::layers() const {
  return impl_->summary.layers;
}
const std::vector<std::string>& MapReader::segment_ids() const { return impl_->segment_ids; }
const Manifest& MapReader::manifest() const { return impl_->manifest; }
const std::string& MapReader::manifest_document() const { return impl_->manifest_document; }
const std::string& MapReader::map_document() const { return impl_->map_document; }

Result<StoredSegment> MapReader::segment(const std::string& id) const {
  const Result<SharedSegment> segment = impl_->segment(id);
  if (!segment) return segment.error();
  return (*segment)->content.segment;
}

Result<std::string> MapReader::segment_document(const std::string& id) const {
  const Result<SharedSegment> segment = impl_->segment(id);
  if (!segment) return segment.error();
  return (*segment)->document;
}

Result<std::vector<TileEntry>> MapReader::tile_index(const std::string& segment,
                                                     const std::string& layer) const {
  return copied(impl_->tiles(segment, layer));
}

Result<std::vector<TileEntry>> MapReader::tiles_in(const std::string& segment,
                                                   const std::string& layer,
                                                   const AlongRange& range) const {
  const auto entries = impl_->tiles(segment, layer);
  if (!entries) return entries.error();
  std::vector<TileEntry> within;
  std::ranges::copy_if(*entries, std::back_inserter(within),
                       [&](const TileEntry& entry) { return entry.along.meets(range); });
  return within;
}

Result<Bytes> MapReader::tile(const std::string& segment, const std::string& layer,
                              std::uint32_t index) const {
  const auto entries = impl_->tiles(segment, layer);
  if (!entries) return entries.error();
  const auto entry = std::ranges::lower_bound(*entries, index, {}, &TileEntry::index);
  if (entry == entries->end() || entry->index != index) {
    return Error{ErrorCode::not_found, impl_->place(),
                 "the map has no tile at " + tile_name(segment, layer, index), ""};
  }
  return tile(segment, layer, *entry);
}

Result<Bytes> MapReader::tile(const std::string& segment, const std::string& layer,
                              const TileEntry& entry) const {
  const auto bind = [&](sqlite::Statement& query) -> sqlite::Statement& {
    return query.bind(1, segment).bind(2, layer).bind(3, static_cast<std::int64_t>(entry.index));
  };
  return impl_->frame(kTileFrame, bind, entry.digest,
                      impl_->place() + ", " + tile_name(segment, layer, entry.index));
}

Result<std::string> MapReader::areas_document() const {
  if (Status read = impl_->read_cells(); !read) return read.error();
  return milepost::areas_document(*impl_->cells);
}

Result<std::vector<CellEntry>> MapReader::cell_index(const std::string& layer) const {
  return copied(impl_->cells_of(layer));
}

Result<std::vector<CellEntry>> MapReader::cells_in(const std::string& layer,
                                                   const Bounds& box) const {
  const auto entries = impl_->cells_of(layer);
  if (!entries) return entries.error();
  std::vector<CellEntry> within;
  std::ranges::copy_if(*entries, std::back_inserter(within), [&](const CellEntry& entry) {
    return GridCell::numbered(entry.cell).bounds().meets(box);
  });
  return within;
}

Result<Bytes> MapReader::cell(const std::string& layer, std::uint32_t number) const {
  const auto entries = impl_->cells_of(layer);
  if (!entries) return entries.error();
  const auto entry = std::ranges::lower_bound(*entries, number, {}, &CellEntry::cell);
  if (entry == entries->end() || entry->cell != number) {
    return Error{ErrorCode::not_found, impl_->place(), "the map has no " + cell_name(layer, number),
                 ""};
  }
  return cell(layer, *entry);
}

Result<Bytes> MapReader::cell(const std::string& layer, const CellEntry& entry) const {
  const auto bind = [&](sqlite::Statement& query) -> sqlite::Statement& {
    return query.bind(1, layer).bind(2, static_cast<std::int64_t>(entry.cell));
  };
  return impl_->frame(kCellFrame, bind, entry.digest,
                      impl_->place() + ", " + cell_name(layer, entry.cell));
}

Result<std::string> MapReader::mapping_document() const {
  std::string text;
  if (Status read = impl_->read_text_if_any("mapping", text); !read) return read.error();
  const std::optional<ListedDocument>& listed = impl_->manifest.mapping;
  if (listed ? listed->is(text) : text.empty()) return text;
  return corrupt(impl_->place(), "the record of its mapping is not that of build " + impl_->build);
}

Status MapReader::verify() const {
  Result<std::string> mapping = mapping_document();
  if (!mapping) return mapping.error();
  MapSummary stated = impl_->summary;
  stated.mapping = std::move(*mapping);
  return verify_map(impl_->database, impl_->build, stated);
}

}  // namespace milepost
