// Building footprints, as OpenStreetMap's are exported.
#pragma once

#include <filesystem>
#include <vector>

#include "schema/base/result.h"
#include "schema/tile/wall.h"

namespace milepost {

// The walls of all Polygons and MultiPolygons of a GeoJSON file (RFC 7946: WGS84, longitude first),
// inner rings too; the building is on the right of each. Other geometries are passed over. Errors:
// not_found, io; invalid_input, naming the place in the file.
Result<std::vector<Wall>> read_footprints(const std::filesystem::path& file);

}  // namespace milepost
