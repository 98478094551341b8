#include "schema/store/map_content.h"

#include <limits>
#include <optional>
#include <utility>

#include "schema/base/digest.h"
#include "schema/base/ids.h"
#include "schema/document/map_documents.h"
#include "schema/store/map_checks.h"
#include "schema/store/map_rows.h"

namespace milepost {
namespace {

enum ContentQuery { kSegmentRow, kVertices, kSuccessors, kPasses, kTiles, kEveryCellRow };
constexpr const char* kContentQueries[] = {
    "SELECT length_m, position_sigma_m IS NOT NULL, position_sigma_m, "
    "position_correlation_m IS NOT NULL, position_correlation_m, assumed FROM segments "
    "WHERE id = ?",
    "SELECT latitude_deg, longitude_deg, altitude_m, along_m FROM vertices WHERE segment = ? "
    "ORDER BY position",
    "SELECT map, successor FROM successors WHERE segment = ? ORDER BY position",
    "SELECT drive, from_m, to_m FROM passes WHERE segment = ? ORDER BY position",
    "SELECT layer, number, from_m, to_m, items, bytes, digest FROM tiles WHERE segment = ? "
    "ORDER BY layer, number",
    "SELECT layer, number, items, bytes, digest FROM cells ORDER BY layer, number",
};

// The name is not quoted: it may hold any bytes.
Status malformed_name(const std::string& where, const std::string& whose) {
  return corrupt(where, whose + " name is malformed");
}

// Whether the columns from `items` on are those of an encoded tile: items, bytes, digest.
bool is_sound_frame(const Rows& row, int items) {
  return row->integer(items) >= 0 && row->integer(items + 1) >= 0 &&
         is_digest(row->text(items + 2)) &&
         check_frame(static_cast<std::uint64_t>(row->integer(items + 1)),
                     static_cast<std::uint64_t>(row->integer(items)), "")
             .ok();
}

bool is_sound_tile(const Rows& row) {
  return is_layer_name(row->text(0)) && row->integer(1) >= 0 &&
         row->integer(1) <= std::numeric_limits<std::uint32_t>::max() &&
         check_along({row->real(2), row->real(3)}, "").ok() && is_sound_frame(row, 4);
}

TileEntry tile_entry_at(const Rows& row) {
  return {static_cast<std::uint32_t>(row->integer(1)),
          {row->real(2), row->real(3)},
          static_cast<std::uint64_t>(row->integer(4)),
          static_cast<std::uint64_t>(row->integer(5)),
          row->text(6)};
}

bool is_sound_cell(const Rows& row) {
  return is_layer_name(row->text(0)) && row->integer(1) >= 0 &&
         row->integer(1) < std::int64_t{kCellRows} * kCellColumns && is_sound_frame(row, 2);
}

CellEntry cell_entry_at(const Rows& row) {
  return {static_cast<std::uint32_t>(row->integer(1)), static_cast<std::uint64_t>(row->integer(2)),
          static_cast<std::uint64_t>(row->integer(3)), row->text(4)};
}

// A failed check is an error of the file here, not of the caller.
Status as_corrupt(const Status& checked) {
  return checked.ok() ? checked : corrupt(checked.error().where, checked.error().what);
}

// Passes each row of a query with one text as its parameter to `use`.
template <class Use>
Status for_each_row_of(sqlite::Statement& query, const std::string& key, Use use) {
  return for_each_row(query.bind(1, key), use);
}

}  // namespace

std::string SegmentContent::document() const { return segment_document(segment, tiles); }

Result<MapContent> MapContent::of(const sqlite::Database& map) {
  std::vector<sqlite::Statement> queries;
  for (const char* sql : kContentQueries) {
    Result<sqlite::Statement> query = map.prepare(sql);
    if (!query) return query.error();
    queries.push_back(std::move(*query));
  }
  return MapContent(map, std::move(queries));
}

Result<MapSummary> MapContent::summary(std::vector<std::string>& ids) const {
  const std::string place = map_->file().string();
  MapSummary summary;
  Status read = for_each_row(*map_, "SELECT name, parameters FROM layers", [&](const Rows& row) {
    if (!is_layer_name(row->text(0))) return malformed_name(place, "a layer's");
    summary.layers[row->text(0)] = row->text(1);
    return ok_status();
  });
  if (!read.ok()) return read.error();
  // Summed in one order, so that the rounding is the same everywhere.
  read = for_each_row(*map_, "SELECT id, length_m FROM segments ORDER BY id", [&](const Rows& row) {
    if (!is_segment_id(row->text(0))) return malformed_name(place, "a segment's");
    ids.push_back(row->text(0));
    ++summary.segments;
    summary.length_m += row->real(1);
    return ok_status();
  });
  if (!read.ok()) return read.error();
  return summary;
}

Status MapContent::read_row(StoredSegment& segment) {
  bool found = false;
  const Status read = for_each_row_of(queries_[kSegmentRow], segment.id, [&](const Rows& row) {
    found = true;
    segment.length_m = row->real(0);
    PositionError& error = segment.position_error;
    if (row->integer(1) != 0) error.sigma_m = row->real(2);
    if (row->integer(3) != 0) error.correlation_m = row->real(4);
    error.is_assumed = row->integer(5) != 0;
    return ok_status();
  });
  if (!read.ok() || found) return read;
  return corrupt(map_->file().string(), "the map lacks segment " + segment.id);
}

Status MapContent::read_vertices(StoredSegment& segment) {
  return for_each_row_of(queries_[kVertices], segment.id, [&](const Rows& row) {
    segment.vertices.push_back({row->real(0), row->real(1), row->real(2), row->real(3)});
    return ok_status();
  });
}

Status MapContent::read_successors(StoredSegment& segment) {
  return for_each_row_of(queries_[kSuccessors], segment.id, [&](const Rows& row) {
    segment.successors.push_back({row->text(1), row->text(0)});
    return ok_status();
  });
}

Status MapContent::read_passes(StoredSegment& segment) {
  return for_each_row_of(queries_[kPasses], segment.id, [&](const Rows& row) {
    segment.passes.push_back({row->text(0), row->real(1), row->real(2)});
    return ok_status();
  });
}

Status MapContent::read_tiles(SegmentContent& content) {
  return for_each_row_of(queries_[kTiles], content.segment.id, [&](const Rows& row) {
    if (!is_sound_tile(row)) {
      const std::string layer = is_layer_name(row->text(0)) ? row->text(0) : "?";
      return Status(corrupt(
          map_->file().string() + ", " + tile_name(content.segment.id, layer, row->integer(1)),
          "the entry in the tile index is damaged"));
    }
    content.tiles[row->text(0)].push_back(tile_entry_at(row));
    return ok_status();
  });
}

Result<SegmentContent> MapContent::segment(const std::string& id) {
  SegmentContent content;
  content.segment.id = id;
  Status status = read_row(content.segment);
  if (status.ok()) status = read_vertices(content.segment);
  if (status.ok()) status = read_successors(content.segment);
  if (status.ok()) status = read_passes(content.segment);
  if (status.ok()) status = as_corrupt(check_segment(content.segment, map_->file().string()));
  if (status.ok()) status = read_tiles(content);
  if (!status.ok()) return status.error();
  return content;
}

Result<CellIndices> MapContent::cells() {
  CellIndices cells;
  const Status read = for_each_row(queries_[kEveryCellRow], [&](const Rows& row) {
    if (!is_sound_cell(row)) {
      const std::string layer = is_layer_name(row->text(0)) ? row->text(0) : "?";
      return Status(corrupt(map_->file().string() + ", " + cell_name(layer, row->integer(1)),
                            "the entry in the index of cells is damaged"));
    }
    cells[row->text(0)].push_back(cell_entry_at(row));
    return ok_status();
  });
  if (!read.ok()) return read.error();
  return cells;
}

Result<Manifest> manifest_of(const sqlite::Database& map, MapSummary stated) {
  Result<MapContent> content = MapContent::of(map);
  if (!content) return content.error();
  std::vector<std::string> ids;
  Result<MapSummary> summary = content->summary(ids);
  if (!summary) return summary.error();
  stated.layers = std::move(summary->layers);
  stated.segments = summary->segments;
  stated.length_m = summary->length_m;
  const Result<std::string> document = map_document(stated);
  if (!document) {
    return corrupt(map.file().string() + ", " + document.error().where, document.error().what);
  }
  const Result<CellIndices> cells = content->cells();
  if (!cells) return cells.error();
  Manifest manifest{ListedDocument::of(*document), ListedDocument::of(areas_document(*cells))};
  if (!stated.mapping.empty()) manifest.mapping = ListedDocument::of(stated.mapping);
  for (const std::string& id : ids) {
    const Result<SegmentContent> segment = content->segment(id);
    if (!segment) return segment.error();
    manifest.segments[id] = ListedDocument::of(segment->document());
  }
  return manifest;
}

Result<Bounds> bounds_of(const sqlite::Database& map) {
  std::optional<Bounds> bounds;
  const auto add = [&bounds](const Bounds& box) { bounds = bounds ? bounds->joined(box) : box; };
  Status status = for_each_row(map,
                               "SELECT min(longitude_deg), min(latitude_deg), max(longitude_deg), "
                               "max(latitude_deg) FROM vertices HAVING count(*) > 0",
                               [&](const Rows& row) {
                                 add({row->real(0), row->real(1), row->real(2), row->real(3)});
                                 return ok_status();
                               });
  if (!status.ok()) return status.error();
  status = for_each_row(map, "SELECT number FROM cells", [&](const Rows& row) {
    add(GridCell::numbered(static_cast<std::uint32_t>(row->integer(0))).bounds());
    return ok_status();
  });
  if (!status.ok()) return status.error();
  return bounds.value_or(Bounds{});
}

}  // namespace milepost
