#include <algorithm>
#include <limits>
#include <utility>

#include "schema/base/digest.h"
#include "schema/store/map_content.h"
#include "schema/store/map_store.h"
#include "schema/store/sqlite.h"

namespace milepost {
namespace fs = std::filesystem;
namespace {

// A map comes from elsewhere: nothing in its schema may run code, and damaged cells are refused.
constexpr const char* kSettings = "PRAGMA trusted_schema = OFF; PRAGMA cell_size_check = ON;";

enum Query {
  kMeta,
  kSegment,
  kVertices,
  kSuccessors,
  kTileIndex,
  kTilesIn,
  kTile,
  kFrame,
  kCells,
  kCell
};
constexpr const char* kQueries[] = {
    "SELECT value FROM meta WHERE key = ?",
    "SELECT length_m FROM segments WHERE id = ?",
    "SELECT latitude_deg, longitude_deg, altitude_m, along_m FROM vertices WHERE segment = ? "
    "ORDER BY position",
    "SELECT successor FROM successors WHERE segment = ? ORDER BY position",
    "SELECT number, from_m, to_m, items, bytes, digest FROM tiles WHERE segment = ? AND layer = ? "
    "ORDER BY number",
    // A millimetre more than the longest tile makes up for the rounding of the differences.
    "SELECT number, from_m, to_m, items, bytes, digest FROM tiles INDEXED BY tiles_by_from "
    "WHERE segment = ?1 AND layer = ?2 AND to_m >= ?3 AND from_m <= ?4 AND from_m >= ?3 - 0.001 - "
    "(SELECT longest_m FROM spans WHERE segment = ?1 AND layer = ?2) ORDER BY number",
    "SELECT digest, frame FROM tiles WHERE segment = ? AND layer = ? AND number = ?",
    "SELECT frame FROM frames WHERE id = ?",
    "SELECT number, items, bytes, digest FROM cells WHERE layer = ? AND number BETWEEN ? AND ? "
    "ORDER BY number",
    "SELECT digest, frame FROM cells WHERE layer = ? AND number = ?",
};

// Every tile with its bytes. A tile whose bytes are missing comes with a NULL frame.
constexpr const char* kEveryFrame =
    "SELECT tiles.segment, tiles.layer, tiles.number, tiles.bytes, tiles.digest, frames.frame "
    "FROM tiles LEFT JOIN frames ON frames.id = tiles.frame "
    "ORDER BY tiles.segment, tiles.layer, tiles.number";
constexpr const char* kEveryCell =
    "SELECT cells.layer, cells.number, cells.bytes, cells.digest, frames.frame "
    "FROM cells LEFT JOIN frames ON frames.id = cells.frame ORDER BY cells.layer, cells.number";
constexpr const char* kWrongSpans =
    "SELECT segment, layer FROM tiles LEFT JOIN spans USING (segment, layer) "
    "WHERE longest_m IS NULL OR to_m - from_m > longest_m LIMIT 1";

std::string tile_name(const std::string& segment, const std::string& layer, std::int64_t index) {
  return "segment " + segment + ", layer " + layer + ", tile " + std::to_string(index);
}

std::string cell_name(const std::string& layer, std::int64_t number) {
  return "layer " + layer + ", cell " + std::to_string(number);
}

Error corrupt(const std::string& where, const std::string& what) {
  return {ErrorCode::corrupt, where, what, "replace the file by a good copy, or make it anew"};
}

// Resets a statement when its rows have been read, however that ended.
class Rows {
 public:
  explicit Rows(sqlite::Statement& statement) : statement_(statement) {}
  ~Rows() { statement_.reset(); }
  Rows(const Rows&) = delete;
  Rows& operator=(const Rows&) = delete;
  Result<bool> next() { return statement_.step(); }
  const sqlite::Statement* operator->() const { return &statement_; }

 private:
  sqlite::Statement& statement_;
};

Result<std::int64_t> pragma(const sqlite::Database& map, const char* name) {
  Result<sqlite::Statement> statement = map.prepare(std::string("PRAGMA ") + name);
  if (!statement) return statement.error();
  const Result<bool> row = statement->step();
  if (!row) return row.error();
  return statement->integer(0);
}

// Whether the file is a map of this format's version.
Status check_format(const sqlite::Database& map) {
  const Result<std::int64_t> application = pragma(map, "application_id");
  if (!application) return application.error();
  if (*application != kMapApplicationId) {
    return corrupt(map.file().string(), "this is no milepost map");
  }
  const Result<std::int64_t> version = pragma(map, "user_version");
  if (!version) return version.error();
  if (*version == kMapFormatVersion) return ok_status();
  return Error{ErrorCode::corrupt, map.file().string(),
               "this is a map of format version " + std::to_string(*version) + ", not " +
                   std::to_string(kMapFormatVersion),
               "build the map with the same version of milepost that reads it"};
}

TileEntry entry_at(const Rows& row) {
  return {static_cast<std::uint32_t>(row->integer(0)),
          {row->real(1), row->real(2)},
          static_cast<std::uint64_t>(row->integer(3)),
          static_cast<std::uint64_t>(row->integer(4)),
          row->text(5)};
}

CellEntry cell_entry_at(const Rows& row) {
  return {static_cast<std::uint32_t>(row->integer(0)), static_cast<std::uint64_t>(row->integer(1)),
          static_cast<std::uint64_t>(row->integer(2)), row->text(3)};
}

bool is_sound_cell(const Rows& row) {
  return row->integer(1) >= 0 && row->integer(2) >= 0 && is_digest(row->text(3));
}

bool is_sound(const Rows& row) {
  return row->integer(0) >= 0 && row->integer(0) <= std::numeric_limits<std::uint32_t>::max() &&
         row->real(1) <= row->real(2) && row->integer(3) >= 0 && row->integer(4) >= 0 &&
         is_digest(row->text(5));
}

}  // namespace

struct MapReader::Impl {
  sqlite::Database database;
  std::vector<sqlite::Statement> queries{};  // go before the connection they belong to
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
    return ok_status();
  }

  // Gives the value of `key` in the table meta to `use`.
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
    if (status.ok() && !is_digest(build)) status = corrupt(place(), "the map's build is no digest");
    if (status.ok()) status = read_text("feature", feature_json);
    if (status.ok()) status = read_number("west_deg", bounds.west_deg);
    if (status.ok()) status = read_number("south_deg", bounds.south_deg);
    if (status.ok()) status = read_number("east_deg", bounds.east_deg);
    if (status.ok()) status = read_number("north_deg", bounds.north_deg);
    return status;
  }

  // Gives each row of a query without parameters to `use`, which may end it by an error.
  template <class Use>
  Status for_each_row(const char* sql, Use use) const {
    Result<sqlite::Statement> statement = database.prepare(sql);
    if (!statement) return statement.error();
    Rows row(*statement);
    while (true) {
      const Result<bool> more = row.next();
      if (!more) return more.error();
      if (!*more) return ok_status();
      const Status used = use(row);
      if (!used.ok()) return used;
    }
  }

  Status read_lists() {
    Status status = for_each_row("SELECT name, parameters FROM layers", [&](const Rows& row) {
      layers[row->text(0)] = row->text(1);
      return ok_status();
    });
    if (!status.ok()) return status;
    return for_each_row("SELECT id FROM segments ORDER BY id", [&](const Rows& row) {
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

  // The cells numbered `first` to `last` that meet the box.
  Result<std::vector<CellEntry>> cells(const std::string& layer, std::uint32_t first,
                                       std::uint32_t last, const Bounds& box) {
    Rows row(query(kCells).bind(1, layer).bind(2, std::int64_t{first}).bind(3, std::int64_t{last}));
    std::vector<CellEntry> entries;
    while (true) {
      const Result<bool> more = row.next();
      if (!more) return more.error();
      if (!*more) return entries;
      if (!is_sound_cell(row)) {
        return corrupt(place() + ", " + cell_name(layer, row->integer(0)),
                       "the entry in the index of cells is damaged");
      }
      const CellEntry entry = cell_entry_at(row);
      if (GridCell::numbered(entry.cell).bounds().meets(box)) entries.push_back(entry);
    }
  }

  Result<std::vector<TileEntry>> entries(Query kind, const std::string& segment,
                                         const std::string& layer) {
    Rows row(query(kind).bind(1, segment).bind(2, layer));
    std::vector<TileEntry> entries;
    while (true) {
      const Result<bool> more = row.next();
      if (!more) return more.error();
      if (!*more) return entries;
      if (!is_sound(row)) {
        return corrupt(place() + ", " + tile_name(segment, layer, row->integer(0)),
                       "the entry in the tile index is damaged");
      }
      entries.push_back(entry_at(row));
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
      segment.successors.push_back(row->text(0));
    }
  }

  Result<Bytes> frame(std::int64_t id, const std::string& digest, const std::string& where) {
    Rows row(query(kFrame).bind(1, id));
    const Result<bool> found = row.next();
    if (!found) return found.error();
    if (!*found) return corrupt(where, "the tile's bytes are missing");
    const ByteView bytes = row->blob(0);
    if (digest_of(bytes) != digest) return corrupt(where, "the tile's bytes break its digest");
    return Bytes(bytes.begin(), bytes.end());
  }

  Status check_integrity() const {
    return for_each_row("PRAGMA integrity_check(1)", [&](const Rows& row) {
      return row->text(0) == "ok" ? ok_status() : Status(corrupt(place(), row->text(0)));
    });
  }

  // Whether the bytes in a row are whole. From the column `bytes` on it has the length, the digest
  // and the frame.
  Status check_frame(const Rows& row, int bytes, const std::string& name) const {
    const ByteView frame = row->blob(bytes + 2);
    if (static_cast<std::int64_t>(frame.size()) == row->integer(bytes) &&
        digest_of(frame) == row->text(bytes + 1)) {
      return ok_status();
    }
    return corrupt(place() + ", " + name, "the tile's bytes break its digest");
  }

  Status check_frames() const {
    const Status tiles = for_each_row(kEveryFrame, [&](const Rows& row) {
      return check_frame(row, 3, tile_name(row->text(0), row->text(1), row->integer(2)));
    });
    if (!tiles.ok()) return tiles;
    return for_each_row(kEveryCell, [&](const Rows& row) {
      return check_frame(row, 2, cell_name(row->text(0), row->integer(1)));
    });
  }

  Status check_spans() const {
    return for_each_row(kWrongSpans, [&](const Rows& row) {
      return Status(corrupt(place() + ", segment " + row->text(0) + ", layer " + row->text(1),
                            "a tile is longer than the longest one"));
    });
  }

  Status check_content() const {
    const Result<std::string> computed = build_of(database);
    if (!computed) return computed.error();
    if (*computed != build) {
      return corrupt(place(), "the content has the build " + *computed + ", not " + build);
    }
    const Result<Bounds> box = bounds_of(database);
    if (!box) return box.error();
    const bool same = box->west_deg == bounds.west_deg && box->south_deg == bounds.south_deg &&
                      box->east_deg == bounds.east_deg && box->north_deg == bounds.north_deg;
    return same ? ok_status()
                : Status(corrupt(place(), "the bounds are not those of the vertices and cells"));
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
  if (status.ok()) status = database->execute(kSettings);
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
  // A box also meets the cells that it only touches: one row more to the south.
  const std::uint32_t south_row = GridCell::at(std::clamp(box.south_deg, -90.0, 90.0), -180).row;
  const GridCell first{south_row > 0 ? south_row - 1 : 0, 0};
  const GridCell last = GridCell::at(std::clamp(box.north_deg, -90.0, 90.0), 180);
  return impl_->cells(layer, first.number(), last.number(), box);
}

Result<Bytes> MapReader::cell(const std::string& layer, std::uint32_t number) const {
  const Status there = impl_->require_layer(layer);
  if (!there.ok()) return there.error();
  const std::string name = cell_name(layer, number);
  Rows row(impl_->query(kCell).bind(1, layer).bind(2, std::int64_t{number}));
  const Result<bool> found = row.next();
  if (!found) return found.error();
  if (!*found) {
    return Error{ErrorCode::not_found, impl_->place(), "the map has no " + name, ""};
  }
  return impl_->frame(row->integer(1), row->text(0), impl_->place() + ", " + name);
}

Status MapReader::verify() const {
  Status status = impl_->check_integrity();
  if (status.ok()) status = impl_->check_frames();
  if (status.ok()) status = impl_->check_spans();
  if (status.ok()) status = impl_->check_content();
  return status;
}

}  // namespace milepost
