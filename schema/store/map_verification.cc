#include "schema/store/map_verification.h"

#include "schema/base/digest.h"
#include "schema/store/map_content.h"
#include "schema/store/map_rows.h"

namespace milepost {
namespace {

// Every tile with its bytes. A tile whose bytes are missing comes with a NULL frame.
constexpr const char* kEveryFrame =
    "SELECT tiles.segment, tiles.layer, tiles.number, tiles.bytes, tiles.digest, frames.frame "
    "FROM tiles LEFT JOIN frames ON frames.id = tiles.frame "
    "ORDER BY tiles.segment, tiles.layer, tiles.number";
constexpr const char* kEveryCell =
    "SELECT cells.layer, cells.number, cells.bytes, cells.digest, frames.frame "
    "FROM cells LEFT JOIN frames ON frames.id = cells.frame ORDER BY cells.layer, cells.number";

Status check_integrity(const sqlite::Database& map) {
  return for_each_row(map, "PRAGMA integrity_check(1)", [&](const Rows& row) {
    return row->text(0) == "ok" ? ok_status() : Status(corrupt(map.file().string(), row->text(0)));
  });
}

// Checks the encoded tile in a row. The columns from `bytes` on are its length, digest and bytes.
Status check_frame(const Rows& row, int bytes, const std::string& where) {
  const ByteView frame = row->blob(bytes + 2);
  if (static_cast<std::int64_t>(frame.size()) == row->integer(bytes) &&
      digest_of(frame) == row->text(bytes + 1)) {
    return ok_status();
  }
  return corrupt(where, "the tile's bytes do not match its digest");
}

Status check_frames(const sqlite::Database& map) {
  const std::string in_map = map.file().string() + ", ";
  const Status tiles = for_each_row(map, kEveryFrame, [&](const Rows& row) {
    return check_frame(row, 3, in_map + tile_name(row->text(0), row->text(1), row->integer(2)));
  });
  if (!tiles.ok()) return tiles;
  return for_each_row(map, kEveryCell, [&](const Rows& row) {
    return check_frame(row, 2, in_map + cell_name(row->text(0), row->integer(1)));
  });
}

Status check_content(const sqlite::Database& map, const std::string& build,
                     const MapSummary& stated) {
  const std::string place = map.file().string();
  const Result<Manifest> manifest = manifest_of(map, stated);
  if (!manifest) return manifest.error();
  const std::string computed = digest_of(as_bytes(manifest_document(*manifest)));
  if (computed != build) {
    return corrupt(place, "the content has the build " + computed + ", not " + build);
  }
  const Result<Bounds> box = bounds_of(map);
  if (!box) return box.error();
  const Bounds& bounds = stated.bounds;
  const bool same = box->west_deg == bounds.west_deg && box->south_deg == bounds.south_deg &&
                    box->east_deg == bounds.east_deg && box->north_deg == bounds.north_deg;
  return same ? ok_status()
              : Status(corrupt(place, "the bounds are not those of the vertices and cells"));
}

}  // namespace

Status verify_map(const sqlite::Database& map, const std::string& build, const MapSummary& stated) {
  Status status = check_integrity(map);
  if (status.ok()) status = check_frames(map);
  if (status.ok()) status = check_content(map, build, stated);
  return status;
}

}  // namespace milepost
