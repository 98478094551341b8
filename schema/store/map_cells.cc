#include "schema/store/map_cells.h"

#include <algorithm>
#include <utility>

#include "schema/base/digest.h"
#include "schema/store/map_checks.h"
#include "schema/store/map_rows.h"

namespace milepost {
namespace {

constexpr const char* kIndex =
    "SELECT number, items, bytes, digest FROM cells WHERE layer = ? AND number BETWEEN ? AND ? "
    "ORDER BY number";
constexpr const char* kCell = "SELECT digest, frame FROM cells WHERE layer = ? AND number = ?";

bool is_sound_cell_row(const Rows& row) {
  return row->integer(1) >= 0 && row->integer(2) >= 0 && is_digest(row->text(3)) &&
         check_frame(static_cast<std::uint64_t>(row->integer(2)),
                     static_cast<std::uint64_t>(row->integer(1)), "")
             .ok();
}

CellEntry cell_entry_at(const Rows& row) {
  return {static_cast<std::uint32_t>(row->integer(0)), static_cast<std::uint64_t>(row->integer(1)),
          static_cast<std::uint64_t>(row->integer(2)), row->text(3)};
}

}  // namespace

Result<MapCells> MapCells::of(const sqlite::Database& map) {
  Result<sqlite::Statement> index = map.prepare(kIndex);
  if (!index) return index.error();
  Result<sqlite::Statement> cell = map.prepare(kCell);
  if (!cell) return cell.error();
  return MapCells(map.file().string(), std::move(*index), std::move(*cell));
}

Result<std::vector<CellEntry>> MapCells::in(const std::string& layer, const Bounds& box) {
  // A box also intersects the cells that it only touches: one more row to the south.
  const std::uint32_t south_row = GridCell::at(std::clamp(box.south_deg, -90.0, 90.0), -180).row;
  const GridCell first{south_row > 0 ? south_row - 1 : 0, 0};
  const GridCell last = GridCell::at(std::clamp(box.north_deg, -90.0, 90.0), 180);
  Rows row(index_.bind(1, layer)
               .bind(2, std::int64_t{first.number()})
               .bind(3, std::int64_t{last.number()}));
  std::vector<CellEntry> entries;
  while (true) {
    const Result<bool> more = row.next();
    if (!more) return more.error();
    if (!*more) return entries;
    if (!is_sound_cell_row(row)) {
      return corrupt(file_ + ", " + cell_name(layer, row->integer(0)),
                     "the entry in the index of cells is damaged");
    }
    const CellEntry entry = cell_entry_at(row);
    if (GridCell::numbered(entry.cell).bounds().meets(box)) entries.push_back(entry);
  }
}

Result<std::optional<MapCells::Place>> MapCells::place_of(const std::string& layer,
                                                          std::uint32_t number) {
  Rows row(cell_.bind(1, layer).bind(2, std::int64_t{number}));
  const Result<bool> found = row.next();
  if (!found) return found.error();
  if (!*found) return std::optional<Place>();
  return std::optional<Place>(Place{row->text(0), row->integer(1)});
}

}  // namespace milepost
