#include "client/fetch/cell_request.h"

#include <algorithm>

#include "client/fetch/documents.h"

namespace milepost {
namespace {

// A rectangle of the grid, including both corner cells.
struct Block {
  GridCell south_west, north_east;
};

Block first_block(const std::vector<CellEntry>& index, const std::set<std::uint32_t>& missing) {
  Block block{GridCell::numbered(*missing.begin()), GridCell::numbered(*missing.begin())};
  for (const std::uint32_t number : missing) {
    const GridCell cell = GridCell::numbered(number);
    block.north_east.row = std::max(block.north_east.row, cell.row);
    block.north_east.column = std::max(block.north_east.column, cell.column);
  }
  std::vector<GridCell> unwanted;
  for (const CellEntry& entry : index) {
    if (!missing.contains(entry.cell)) unwanted.push_back(GridCell::numbered(entry.cell));
  }
  // Extends as far to the east as the row allows, then as far to the north.
  for (const GridCell& cell : unwanted) {
    if (cell.row == block.south_west.row && cell.column > block.south_west.column) {
      block.north_east.column = std::min(block.north_east.column, cell.column - 1);
    }
  }
  for (const GridCell& cell : unwanted) {
    const bool in_columns =
        cell.column >= block.south_west.column && cell.column <= block.north_east.column;
    if (in_columns && cell.row > block.south_west.row) {
      block.north_east.row = std::min(block.north_east.row, cell.row - 1);
    }
  }
  return block;
}

// From centre to centre of the corner cells: a box along their borders would meet the neighbours.
Bounds box_within(const Block& block) {
  const Bounds first = block.south_west.bounds();
  const Bounds last = block.north_east.bounds();
  return {(first.west_deg + first.east_deg) / 2, (first.south_deg + first.north_deg) / 2,
          (last.west_deg + last.east_deg) / 2, (last.south_deg + last.north_deg) / 2};
}

}  // namespace

CellRequest request_for_first_block(const std::vector<CellEntry>& index,
                                    const std::set<std::uint32_t>& missing) {
  const Bounds box = box_within(first_block(index, missing));
  std::vector<CellEntry> expected = entries_meeting(index, box);
  if (expected.size() == 1) return {std::nullopt, std::move(expected)};
  return {box, std::move(expected)};
}

Status check_area_query(const Bounds& box) {
  if (box.is_valid()) return ok_status();
  return Error{ErrorCode::invalid_input, "cells of a box",
               "a side is out of range, or south is greater than north",
               "use WGS84 degrees: longitudes in [-180, 180], latitudes in [-90, 90]"};
}

}  // namespace milepost
