// Walls for other programs to show.
#pragma once

#include <string>
#include <vector>

#include "schema/tile/wall.h"

namespace milepost {

// A GeoJSON FeatureCollection (RFC 7946): one LineString a wall, with its sigma_m.
std::string geojson_of(const std::vector<Wall>& walls);

}  // namespace milepost
