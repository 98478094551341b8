// A wall of a building in plan view, and the walls of one cell of the grid.
// The aerial paper, section II: line segments that are building boundaries.
#pragma once

#include <compare>
#include <cstdint>
#include <vector>

#include "schema/base/cell_grid.h"

namespace milepost {

// Positions are stored in steps of 1e-8 degrees: about a millimetre.
struct WallEnd {
  double latitude_deg = 0;   // [-90, 90], WGS84
  double longitude_deg = 0;  // [-180, 180], WGS84

  // NOLINTNEXTLINE(modernize-use-nullptr): false positive for any defaulted <=>
  friend auto operator<=>(const WallEnd&, const WallEnd&) = default;
};

struct Wall {
  WallEnd begin, end;    // the interior of a building, if known, is on the right
  double sigma_m = 0.5;  // of a point's distance from the true wall: (0, 655], steps of 1 cm

  // NOLINTNEXTLINE(modernize-use-nullptr): false positive for any defaulted <=>
  friend auto operator<=>(const Wall&, const Wall&) = default;
};

// The walls whose box intersects the cell. A wall across a border is stored whole in each cell.
struct WallTile {
  std::uint32_t cell = 0;   // is_cell
  std::vector<Wall> walls;  // ascending
};

// The bounding box of a wall. REQUIRES: it does not cross longitude 180.
Bounds bounds_of(const Wall& wall);

// The wall after encoding and decoding.
Wall quantized(const Wall& wall);

// The tiles of walls, ascending by cell: quantized, sorted, without duplicates in a cell and
// without walls of zero length. REQUIRES: every wall is in range, spans no more than 0.1 degrees
// and does not cross longitude 180.
std::vector<WallTile> tiles_of(const std::vector<Wall>& walls);

// The walls of several tiles, sorted, without duplicates.
std::vector<Wall> walls_of(const std::vector<WallTile>& tiles);

}  // namespace milepost
