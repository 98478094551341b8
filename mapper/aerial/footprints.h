// Building footprints in GeoJSON, as exported from OpenStreetMap.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "schema/base/result.h"
#include "schema/tile/wall.h"

namespace milepost {

struct Footprints {
  std::vector<Wall> walls;
  std::string contents;  // for messages: "12 Points, 3 LineStrings and no Polygon"
};

// The walls of all Polygons and MultiPolygons of a GeoJSON file (RFC 7946: WGS84, longitude first),
// including inner rings; the building is on the right of each. Other geometries are skipped. A ring
// may cross longitude 180, by longitudes beyond it or by a jump to the other sign; a wall has its
// ends in [-180, 180] and is the shorter way between them. Edges along longitude 180 with a polygon
// on either side are not walls: a building was cut there. Errors: not_found, io; invalid_input,
// naming the location in the file: not GeoJSON, more than 512 MB, 50 million values or 64 levels,
// an unknown type, an invalid ring.
Result<Footprints> read_footprints(const std::filesystem::path& file);

// The same for a text; `name` replaces the file in messages.
Result<Footprints> footprints_in(std::string_view text, const std::string& name);

}  // namespace milepost
