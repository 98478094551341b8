// The layer of walls as a vehicle that looks for itself needs it: which maps have it, and the walls
// about a place.
#pragma once

#include <string>
#include <vector>

#include "client/fetch/map_source.h"
#include "schema/base/cell_grid.h"
#include "schema/base/result.h"
#include "schema/tile/layer_parameters.h"
#include "schema/tile/wall.h"

namespace milepost {

// The maps of the source that have a layer layers::kWalls, by name. Their bounds say where a
// vehicle that knows nothing of its position may be. Errors: those of MapSource::maps and describe.
Result<std::vector<MapDescription>> maps_with_walls(MapSource& source);

// The walls of a map's layer in the cells that meet `box`, borders included: sorted, each once.
// Errors: those of MapSource::cells; corrupt, naming the map, the layer and the cell.
Result<std::vector<Wall>> walls_in(MapSource& source, const MapVersion& version,
                                   const std::string& layer, const Bounds& box);

// The walls that a vehicle in `area` may see, as far as `view_m`: they may lie outside of it. An
// area that has all longitudes keeps them. Errors: those of walls_in.
Result<std::vector<Wall>> walls_seen_from(MapSource& source, const MapVersion& version,
                                          const Bounds& area, double view_m);

}  // namespace milepost
