#include "client/fetch/walls.h"

#include <utility>

#include "schema/geo/geodesy.h"
#include "schema/tile/codec.h"

namespace milepost {
namespace {

Bounds with_view(const Bounds& area, double view_m) {
  const GeoPoint south_west =
      LocalFrame({area.south_deg, area.west_deg, 0}).geo_from_enu({-view_m, -view_m, 0});
  const GeoPoint north_east =
      LocalFrame({area.north_deg, area.east_deg, 0}).geo_from_enu({view_m, view_m, 0});
  Bounds view{south_west.longitude_deg, south_west.latitude_deg, north_east.longitude_deg,
              north_east.latitude_deg};
  if (area.east_deg - area.west_deg > 180 && view.crosses_180()) {
    view.west_deg = -180;
    view.east_deg = 180;
  }
  return view;
}

}  // namespace

Result<std::vector<MapDescription>> maps_with_walls(MapSource& source) {
  const Result<std::vector<MapVersion>> versions = source.maps();
  if (!versions.ok()) return versions.error();
  std::vector<MapDescription> maps;
  for (const MapVersion& version : *versions) {
    Result<MapDescription> map = source.describe(version);
    if (!map.ok()) return map.error();
    if (map->layers.contains(layers::kWalls)) maps.push_back(std::move(*map));
  }
  return maps;
}

Result<std::vector<Wall>> walls_in(MapSource& source, const MapVersion& version,
                                   const std::string& layer, const Bounds& box) {
  const Result<std::vector<EncodedCell>> cells = source.cells(version, layer, box);
  if (!cells.ok()) return cells.error();
  std::vector<WallTile> tiles;
  for (const EncodedCell& cell : *cells) {
    Result<WallTile> tile = decode_walls(cell.bytes);
    const bool as_named = tile.ok() && tile->cell == cell.cell;
    if (!as_named) {
      return Error{
          ErrorCode::corrupt,
          "map '" + version.map + "', layer '" + layer + "', cell " + std::to_string(cell.cell),
          tile.ok() ? "it holds the walls of cell " + std::to_string(tile->cell)
                    : tile.error().what,
          "build the map anew"};
    }
    tiles.push_back(std::move(*tile));
  }
  return walls_of(tiles);
}

Result<std::vector<Wall>> walls_seen_from(MapSource& source, const MapVersion& version,
                                          const Bounds& area, double view_m) {
  const Bounds view = with_view(area, view_m);
  Result<std::vector<Wall>> walls = walls_in(source, version, layers::kWalls, view);
  if (walls) std::erase_if(*walls, [&](const Wall& wall) { return !bounds_of(wall).meets(view); });
  return walls;
}

}  // namespace milepost
