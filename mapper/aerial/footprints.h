// Building footprints, as OpenStreetMap's are exported.
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
  std::string contents;  // in words: "12 Points, 3 LineStrings and no Polygon"
};

// The walls of all Polygons and MultiPolygons of a GeoJSON file (RFC 7946: WGS84, longitude first),
// inner rings too; the building is on the right of each. Other geometries are passed over. A ring
// may go across longitude 180, by longitudes beyond it or by a jump to the other sign; a wall has
// its ends in [-180, 180] and is the shorter way between them. Edges along longitude 180 at which
// two polygons lie on either side are no walls: a building was cut there. Errors: not_found, io;
// invalid_input, naming the place in the file: no GeoJSON, beyond 512 MB, 50 million values or 64
// levels, an unknown type, a broken ring.
Result<Footprints> read_footprints(const std::filesystem::path& file);

// The same of a text; `name` stands for the file in messages.
Result<Footprints> footprints_in(std::string_view text, const std::string& name);

}  // namespace milepost
