#include "client/fetch/walls.h"

#include <utility>

#include "schema/tile/codec.h"

namespace milepost {

Result<std::vector<MapDescription>> maps_with_walls(MapSource& source) {
  const Result<std::vector<MapVersion>> versions = source.maps();
  if (!versions.ok()) return versions.error();
  std::vector<MapDescription> maps;
  for (const MapVersion& version : *versions) {
    Result<MapDescription> map = source.describe(version);
    if (!map.ok()) return map.error();
    if (map->layers.contains(kWallsLayer)) maps.push_back(std::move(*map));
  }
  return maps;
}

Result<std::vector<Wall>> walls_in(MapSource& source, const MapVersion& version,
                                   const std::string& layer, const Bounds& box) {
  const Result<std::vector<CellFrame>> frames = source.cells(version, layer, box);
  if (!frames.ok()) return frames.error();
  std::vector<WallTile> tiles;
  for (const CellFrame& frame : *frames) {
    Result<WallTile> tile = decode_walls(frame.frame);
    const bool as_named = tile.ok() && tile->cell == frame.cell;
    if (!as_named) {
      return Error{
          ErrorCode::corrupt,
          "map '" + version.map + "', layer '" + layer + "', cell " + std::to_string(frame.cell),
          tile.ok() ? "it holds the walls of cell " + std::to_string(tile->cell)
                    : tile.error().what,
          "build the map anew"};
    }
    tiles.push_back(std::move(*tile));
  }
  return walls_of(tiles);
}

}  // namespace milepost
