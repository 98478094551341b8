// Export of a map's content as GeoJSON (RFC 7946), for other programs.
#pragma once

#include <cstddef>
#include <string>

#include "schema/base/result.h"
#include "schema/store/map_store.h"

namespace milepost {

// The layer name that selects the network of segments.
inline constexpr const char* kSegments = "segments";

struct GeoJson {
  std::string text;  // a FeatureCollection, one feature per line; deterministic
  std::size_t features = 0;
};

// Each segment's line in WGS84, [longitude_deg, latitude_deg, altitude_m], with the properties id,
// length_m, successors (each with `map` and `segment`) and passes (`drive`, `from_m`, `to_m`). A
// line across longitude 180 is split there into a MultiLineString (RFC 7946, 3.1.9). Errors: those
// of MapReader; corrupt (a segment without a line).
Result<GeoJson> segments_geojson(const MapReader& map);

// Each wall of a layer once, from its begin to its end in WGS84, [longitude_deg, latitude_deg],
// with the property sigma_m. Errors: not_found (no such layer; lists the existing ones),
// invalid_input (a layer of other items), corrupt (a tile), those of MapReader.
Result<GeoJson> walls_geojson(const MapReader& map, const std::string& layer);

}  // namespace milepost
