// A wall of a building in plan view, and the walls of one cell of the grid.
// The aerial paper, section II: line segments that are building boundaries.
#pragma once

#include <compare>
#include <cstdint>
#include <vector>

#include "schema/base/cell_grid.h"

namespace milepost {

// Positions are kept in steps of 1e-8 degrees: about a millimetre.
struct WallEnd {
  double latitude_deg = 0;   // [-90, 90], WGS84
  double longitude_deg = 0;  // [-180, 180], WGS84

  // NOLINTNEXTLINE(modernize-use-nullptr): what clang-tidy makes of any defaulted <=>
  friend auto operator<=>(const WallEnd&, const WallEnd&) = default;
};

struct Wall {
  WallEnd begin, end;    // the interior of a building, where it is known, is on the right
  double sigma_m = 0.5;  // of a point's distance from the true wall: (0, 655], steps of 1 cm

  // NOLINTNEXTLINE(modernize-use-nullptr): what clang-tidy makes of any defaulted <=>
  friend auto operator<=>(const Wall&, const Wall&) = default;
};

// The walls whose box meets the cell. A wall that crosses a border is whole in each of its cells.
struct WallTile {
  std::uint32_t cell = 0;   // is_cell
  std::vector<Wall> walls;  // ascending
};

// The box around a wall. REQUIRES: it does not cross longitude 180.
Bounds bounds_of(const Wall& wall);

// The wall as it comes back from its bytes.
Wall quantized(const Wall& wall);

// The tiles of walls, ascending by cell: quantized, sorted, each wall once a cell, those without
// length left out. REQUIRES: every wall is in range, spans no more than 0.1 degrees and does not
// cross longitude 180.
std::vector<WallTile> tiles_of(const std::vector<Wall>& walls);

// The walls of several tiles, sorted, those in more than one tile once.
std::vector<Wall> walls_of(const std::vector<WallTile>& tiles);

}  // namespace milepost
