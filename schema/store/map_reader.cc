#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "schema/base/digest.h"
#include "schema/store/map_cells.h"
#include "schema/store/map_checks.h"
#include "schema/store/map_content.h"
#include "schema/store/map_rows.h"
#include "schema/store/map_store.h"
#include "schema/store/map_verification.h"
#include "schema/store/sqlite.h"

namespace milepost {
namespace fs = std::filesystem;
namespace {

// A map is untrusted: nothing in its schema may run code, and damaged cells are rejected.
constexpr const char* kReadSettings = "PRAGMA trusted_schema = OFF; PRAGMA cell_size_check = ON;";

enum Query { kMeta, kSegment, kVertices, kSuccessors, kTileIndex, kTilesIn, kTile, kFrame };
constexpr const char* kQueries[] = {
    "SELECT value FROM meta WHERE key = ?",
    "SELECT length_m FROM segments WHERE id = ?",
    "SELECT latitude_deg, longitude_deg, altitude_m, along_m FROM vertices WHERE segment = ? "
    "ORDER BY position",
    "SELECT successor FROM successors WHERE segment = ? ORDER BY position",
    "SELECT number, from_m, to_m, items, bytes, digest FROM tiles WHERE segment = ? AND layer = ? "
    "ORDER BY number",
    // A millimetre more than the longest tile compensates for the rounding of the differences.
    "SELECT number, from_m, to_m, items, bytes, digest FROM tiles INDEXED BY tiles_by_from "
    "WHERE segment = ?1 AND layer = ?2 AND to_m >= ?3 AND from_m <= ?4 AND from_m >= ?3 - 0.001 - "
    "(SELECT longest_m FROM spans WHERE segment = ?1 AND layer = ?2) ORDER BY number",
    "SELECT digest, frame FROM tiles WHERE segment = ? AND layer = ? AND number = ?",
    "SELECT frame FROM frames WHERE id = ?",
};

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
               "build the map with the same version of milepost that reads it"};
}

TileEntry tile_entry_at(const Rows& row) {
  return {static_cast<std::uint32_t>(row->integer(0)),
          {row->real(1), row->real(2)},
          static_cast<std::uint64_t>(row->integer(3)),
          static_cast<std::uint64_t>(row->integer(4)),
          row->text(5)};
}

bool is_sound_tile_row(const Rows& row) {
  return row->integer(0) >= 0 && row->integer(0) <= std::numeric_limits<std::uint32_t>::max() &&
         row->integer(3) >= 0 && row->integer(4) >= 0 && is_digest(row->text(5)) &&
         check_along({row->real(1), row->real(2)}, "").ok() &&
         check_frame(static_cast<std::uint64_t>(row->integer(4)),
                     static_cast<std::uint64_t>(row->integer(3)), "")
             .ok();
}

// The name is not quoted: it may hold any bytes.
Status malformed_name(const std::string& where, const std::string& whose) {
  return corrupt(where, whose + " name is malformed");
}

// A failed check is an error of the file here, not of the caller.
Status as_corrupt(const Status& checked) {
  return checked.ok() ? checked : corrupt(checked.error().where, checked.error().what);
}

}  // namespace

struct MapReader::Impl {
  sqlite::Database database;
  std::vector<sqlite::Statement> queries{};  // destroyed before their connection
  std::optional<MapCells> cells{};           // the same
  std::string build{};
  std::string feature_json{};
  Bounds bounds{};
  std::map<std::string, std::string> layers{};
  std::vector<std::string> segment_ids{};

  std::string place() const { return database.file().string(); }
  sqlite::Statement& query(Query kind) { return queries[kind]; }

  Status prepare() {
    for (const char* sql : kQueries) {
      Result<sqlite::Statement> query = database.prepare(sql);
      if (!query) return query.error();
      queries.push_back(std::move(*query));
    }
    Result<MapCells> table = MapCells::of(database);
    if (!table) return table.error();
    cells = std::move(*table);
    return ok_status();
  }

  // Passes the value of `key` in the table meta to `use`.
  template <class Use>
  Status read_meta(const char* key, Use use) {
    Rows row(query(kMeta).bind(1, std::string_view(key)));
    const Result<bool> found = row.next();
    if (!found) return found.error();
    if (!*found) return corrupt(place(), std::string("the map lacks its ") + key);
    use(row);
    return ok_status();
  }

  Status read_number(const char* key, double& value) {
    return read_meta(key, [&](const Rows& row) { value = row->real(0); });
  }

  Status read_text(const char* key, std::string& value) {
    return read_meta(key, [&](const Rows& row) { value = row->text(0); });
  }

  Status read_all_meta() {
    Status status = read_text("build", build);
    if (status.ok() && !is_digest(build)) {
      status = corrupt(place(), "the map's build is not a digest");
    }
    if (status.ok()) status = read_text("feature", feature_json);
    if (status.ok()) status = read_number("west_deg", bounds.west_deg);
    if (status.ok()) status = read_number("south_deg", bounds.south_deg);
    if (status.ok()) status = read_number("east_deg", bounds.east_deg);
    if (status.ok()) status = read_number("north_deg", bounds.north_deg);
    const bool is_box = std::abs(bounds.west_deg) <= 180 && std::abs(bounds.east_deg) <= 180 &&
                        std::abs(bounds.south_deg) <= 90 && std::abs(bounds.north_deg) <= 90;
    if (status.ok() && !is_box) status = corrupt(place(), "the map's bounds are not in degrees");
    return status;
  }

  Status read_lists() {
    Status status =
        for_each_row(database, "SELECT name, parameters FROM layers", [&](const Rows& row) {
          if (!is_layer_name(row->text(0))) return malformed_name(place(), "a layer's");
          layers[row->text(0)] = row->text(1);
          return ok_status();
        });
    if (!status.ok()) return status;
    return for_each_row(database, "SELECT id FROM segments ORDER BY id", [&](const Rows& row) {
      if (!is_segment_id(row->text(0))) return malformed_name(place(), "a segment's");
      segment_ids.push_back(row->text(0));
      return ok_status();
    });
  }

  Error no_segment(const std::string& id) const {
    return {ErrorCode::not_found, place(), "the map has no segment " + id, ""};
  }

  Status require_layer(const std::string& layer) const {
    if (layers.contains(layer)) return ok_status();
    return Error{ErrorCode::not_found, place(), "the map has no layer " + layer, ""};
  }

  Status require(const std::string& segment, const std::string& layer) const {
    if (!std::ranges::binary_search(segment_ids, segment)) return no_segment(segment);
    return require_layer(layer);
  }

  Result<std::vector<TileEntry>> entries(Query kind, const std::string& segment,
                                         const std::string& layer) {
    Rows row(query(kind).bind(1, segment).bind(2, layer));
    std::vector<TileEntry> entries;
    while (true) {
      const Result<bool> more = row.next();
      if (!more) return more.error();
      if (!*more) return entries;
      if (!is_sound_tile_row(row)) {
        return corrupt(place() + ", " + tile_name(segment, layer, row->integer(0)),
                       "the entry in the tile index is damaged");
      }
      entries.push_back(tile_entry_at(row));
    }
  }

  Status read_vertices(StoredSegment& segment) {
    Rows row(query(kVertices).bind(1, segment.id));
    while (true) {
      const Result<bool> more = row.next();
      if (!more) return more.error();
      if (!*more) return ok_status();
      segment.vertices.push_back({row->real(0), row->real(1), row->real(2), row->real(3)});
    }
  }

  Status read_successors(StoredSegment& segment) {
    Rows row(query(kSuccessors).bind(1, segment.id));
    while (true) {
      const Result<bool> more = row.next();
      if (!more) return more.error();
      if (!*more) return ok_status();
      if (!is_segment_id(row->text(0))) {
        return malformed_name(place() + ", segment " + segment.id, "a successor's");
      }
      segment.successors.push_back(row->text(0));
    }
  }

  Result<Bytes> frame(std::int64_t id, const std::string& digest, const std::string& where) {
    Rows row(query(kFrame).bind(1, id));
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
  Result<sqlite::Database> database = sqlite::Database::open(file, sqlite::Access::immutable);
  if (!database) return database.error();
  Status status = check_format(*database);
  if (status.ok()) status = database->execute(kReadSettings);
  if (!status.ok()) return status.error();
  auto impl = std::make_unique<Impl>(Impl{std::move(*database)});
  status = impl->prepare();
  if (status.ok()) status = impl->read_all_meta();
  if (status.ok()) status = impl->read_lists();
  if (!status.ok()) return status.error();
  return MapReader(std::move(impl));
}

const fs::path& MapReader::file() const { return impl_->database.file(); }
const std::string& MapReader::build() const { return impl_->build; }
const std::string& MapReader::feature_json() const { return impl_->feature_json; }
const Bounds& MapReader::bounds() const { return impl_->bounds; }
const std::map<std::string, std::string>& MapReader::layers() const { return impl_->layers; }
const std::vector<std::string>& MapReader::segment_ids() const { return impl_->segment_ids; }

Result<StoredSegment> MapReader::segment(const std::string& id) const {
  StoredSegment segment{id, 0, {}, {}};
  {
    Rows row(impl_->query(kSegment).bind(1, id));
    const Result<bool> found = row.next();
    if (!found) return found.error();
    if (!*found) return impl_->no_segment(id);
    segment.length_m = row->real(0);
  }
  Status status = impl_->read_vertices(segment);
  if (status.ok()) status = impl_->read_successors(segment);
  if (status.ok()) status = as_corrupt(check_segment(segment, impl_->place()));
  if (!status.ok()) return status.error();
  return segment;
}

Result<std::vector<TileEntry>> MapReader::tile_index(const std::string& segment,
                                                     const std::string& layer) const {
  const Status there = impl_->require(segment, layer);
  if (!there.ok()) return there.error();
  return impl_->entries(kTileIndex, segment, layer);
}

Result<std::vector<TileEntry>> MapReader::tiles_in(const std::string& segment,
                                                   const std::string& layer,
                                                   const AlongRange& range) const {
  const Status there = impl_->require(segment, layer);
  if (!there.ok()) return there.error();
  impl_->query(kTilesIn).bind(3, range.from_m).bind(4, range.to_m);
  return impl_->entries(kTilesIn, segment, layer);
}

Result<Bytes> MapReader::tile(const std::string& segment, const std::string& layer,
                              std::uint32_t index) const {
  const Status there = impl_->require(segment, layer);
  if (!there.ok()) return there.error();
  const std::string name = tile_name(segment, layer, index);
  Rows row(impl_->query(kTile)
               .bind(1, segment)
               .bind(2, layer)
               .bind(3, static_cast<std::int64_t>(index)));
  const Result<bool> found = row.next();
  if (!found) return found.error();
  if (!*found) {
    return Error{ErrorCode::not_found, impl_->place(), "the map has no tile at " + name, ""};
  }
  return impl_->frame(row->integer(1), row->text(0), impl_->place() + ", " + name);
}

Result<std::vector<CellEntry>> MapReader::cell_index(const std::string& layer) const {
  return cells_in(layer, {-180, -90, 180, 90});
}

Result<std::vector<CellEntry>> MapReader::cells_in(const std::string& layer,
                                                   const Bounds& box) const {
  const Status there = impl_->require_layer(layer);
  if (!there.ok()) return there.error();
  return impl_->cells->in(layer, box);
}

Result<Bytes> MapReader::cell(const std::string& layer, std::uint32_t number) const {
  const Status there = impl_->require_layer(layer);
  if (!there.ok()) return there.error();
  const std::string name = cell_name(layer, number);
  const Result<std::optional<MapCells::Place>> place = impl_->cells->place_of(layer, number);
  if (!place) return place.error();
  if (!*place) return Error{ErrorCode::not_found, impl_->place(), "the map has no " + name, ""};
  return impl_->frame((*place)->frame, (*place)->digest, impl_->place() + ", " + name);
}

Status MapReader::verify() const {
  return verify_map(impl_->database, impl_->build, impl_->bounds);
}

}  // namespace milepost
