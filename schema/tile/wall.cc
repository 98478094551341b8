#include "schema/tile/wall.h"

#include <algorithm>
#include <map>

#include "schema/tile/wall_steps.h"

namespace milepost {
namespace {

void sort_once_each(std::vector<Wall>& walls) {
  std::ranges::sort(walls);
  walls.erase(std::unique(walls.begin(), walls.end()), walls.end());
}

}  // namespace

Bounds bounds_of(const Wall& wall) {
  const auto [south_deg, north_deg] = std::minmax(wall.begin.latitude_deg, wall.end.latitude_deg);
  const auto [west_deg, east_deg] = std::minmax(wall.begin.longitude_deg, wall.end.longitude_deg);
  return {west_deg, south_deg, east_deg, north_deg};
}

Wall quantized(const Wall& wall) {
  const std::uint32_t cell =
      GridCell::at(wall.begin.latitude_deg, wall.begin.longitude_deg).number();
  return wall_of(steps_of(wall, cell), cell);
}

std::vector<WallTile> tiles_of(const std::vector<Wall>& walls) {
  std::map<std::uint32_t, std::vector<Wall>> walls_by_cell;
  for (const Wall& exact : walls) {
    const Wall wall = quantized(exact);
    if (wall.begin == wall.end) continue;
    const Bounds box = bounds_of(wall);
    const GridCell first = GridCell::at(box.south_deg, box.west_deg);
    const GridCell last = GridCell::at(box.north_deg, box.east_deg);
    for (std::uint32_t row = first.row; row <= last.row; ++row) {
      for (std::uint32_t column = first.column; column <= last.column; ++column) {
        walls_by_cell[GridCell{row, column}.number()].push_back(wall);
      }
    }
  }
  std::vector<WallTile> tiles;
  for (auto& [cell, walls_in_cell] : walls_by_cell) {
    sort_once_each(walls_in_cell);
    tiles.push_back({cell, std::move(walls_in_cell)});
  }
  return tiles;
}

std::vector<Wall> walls_of(const std::vector<WallTile>& tiles) {
  std::vector<Wall> walls;
  for (const WallTile& tile : tiles)
    walls.insert(walls.end(), tile.walls.begin(), tile.walls.end());
  sort_once_each(walls);
  return walls;
}

}  // namespace milepost
