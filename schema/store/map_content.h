// Reads what a map holds from its tables, for its writer and its readers alike. Names and numbers
// are checked, the digests of FORMAT.md 7 are not.
#pragma once

#include <string>
#include <vector>

#include "schema/base/result.h"
#include "schema/document/manifest.h"
#include "schema/document/stored_map.h"
#include "schema/store/sqlite.h"

namespace milepost {

// PRAGMA application_id and user_version of map.sql.
inline constexpr std::int64_t kMapApplicationId = 0x4D504D31;  // "MPM1"
inline constexpr auto kMapFormatVersion = static_cast<std::int64_t>(kMapFormat);

// A segment with the index of its tiles.
struct SegmentContent {
  StoredSegment segment;
  TileIndices tiles;

  std::string document() const;
};

// The map's Database must outlive it.
class MapContent {
 public:
  // Errors of all: corrupt, which names the place in the file; io.
  static Result<MapContent> of(const sqlite::Database& map);

  // Without what the table meta has. Adds the ids of the segments, ascending, to `ids`.
  Result<MapSummary> summary(std::vector<std::string>& ids) const;
  Result<SegmentContent> segment(const std::string& id);
  Result<CellIndices> cells();

 private:
  MapContent(const sqlite::Database& map, std::vector<sqlite::Statement> queries)
      : map_(&map), queries_(std::move(queries)) {}

  Status read_row(StoredSegment& segment);
  Status read_vertices(StoredSegment& segment);
  Status read_successors(StoredSegment& segment);
  Status read_passes(StoredSegment& segment);
  Status read_tiles(SegmentContent& content);

  const sqlite::Database* map_;
  std::vector<sqlite::Statement> queries_;
};

// The manifest of the tables' content. Of `stated` is taken what the table meta has. Errors: those
// of MapContent.
Result<Manifest> manifest_of(const sqlite::Database& map, MapSummary stated);

// The smallest box around all vertices and cells; zeros without either.
Result<Bounds> bounds_of(const sqlite::Database& map);

}  // namespace milepost
