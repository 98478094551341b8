// Access to the layers of walls: the maps that have one, and the walls around an area.
#pragma once

#include <string>
#include <vector>

#include "client/fetch/map_source.h"
#include "schema/base/cell_grid.h"
#include "schema/base/result.h"
#include "schema/tile/layer_parameters.h"
#include "schema/tile/wall.h"

namespace milepost {

// The maps of the source that have a layer layers::kWalls, ordered by name. Their bounds limit the
// positions of a vehicle without a prior. Errors: those of MapSource::maps and describe.
Result<std::vector<MapDescription>> maps_with_walls(MapSource& source);

// The walls of a map's layer in the cells that meet `box`, borders included: sorted and unique.
// Errors: those of MapSource::cells; corrupt, naming the map, the layer and the cell.
Result<std::vector<Wall>> walls_in(MapSource& source, const MapVersion& version,
                                   const std::string& layer, const Bounds& box);

// The walls visible from within `area` up to the distance `view_m`, including walls outside of it.
// An area that spans all longitudes keeps them. Errors: those of walls_in.
Result<std::vector<Wall>> walls_seen_from(MapSource& source, const MapVersion& version,
                                          const Bounds& area, double view_m);

}  // namespace milepost
