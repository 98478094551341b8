// The JSON documents of a map, of a segment and of a map's cells (PROTOCOL.md).
#pragma once

#include <map>
#include <string>
#include <vector>

#include "schema/store/map_store.h"

namespace milepost::server {

// The document of GET /v1/maps/{map}.
// Errors: corrupt (a stored parameter object is not JSON).
Result<std::string> map_document(const std::string& name, const MapReader& reader, double length_m);

// The document of GET /v1/maps/{map}/builds/{build}/segments/{segment}.
std::string segment_document(const std::string& map, const std::string& build,
                             const StoredSegment& segment,
                             const std::map<std::string, std::vector<TileEntry>>& tiles);

// The document of GET /v1/maps/{map}/builds/{build}/areas: the layers that have cells.
std::string areas_document(const std::string& map, const std::string& build,
                           const std::map<std::string, std::vector<CellEntry>>& cells);

}  // namespace milepost::server
