// The documents of a build (FORMAT.md 7). Their bytes depend on the map's content only, so that the
// writer of a map, a server and a client get the same digests.
#pragma once

#include <string>

#include "schema/base/result.h"
#include "schema/document/stored_map.h"

namespace milepost {

// Errors: corrupt (the parameters of a layer or of the features are not a JSON object), with
// `where` naming them.
Result<std::string> map_document(const MapSummary& map);

std::string segment_document(const StoredSegment& segment, const TileIndices& tiles);

// The index of the map's cells.
std::string areas_document(const CellIndices& cells);

}  // namespace milepost
