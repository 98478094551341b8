// The layer `walls` of a map.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "schema/base/result.h"
#include "schema/tile/layer_parameters.h"
#include "schema/tile/wall.h"

namespace milepost {

struct WallLayerReport {
  std::string build;
  std::size_t walls = 0;  // as stored: cut, without duplicates
  double length_m = 0;    // of them all
  std::size_t cells = 0;
};

// Writes a map with the walls in the layer `walls`, as storable_walls cuts them. If `map_file`
// exists, its other content is kept and only this layer is replaced. The file appears complete or
// not at all, and is readable. Errors: corrupt (the old map), invalid_input (too many walls in one
// cell, or in all cells together; those of storable_walls), io.
Result<WallLayerReport> write_wall_layer(const std::filesystem::path& map_file,
                                         const std::vector<Wall>& walls,
                                         const WallLayerParameters& parameters);

}  // namespace milepost
