// Whether a map is what it claims: every digest, tile, link and line.
#pragma once

#include <vector>

#include "mapper/findings/finding.h"
#include "schema/store/map_store.h"

namespace milepost {

// What contradicts, of these kinds: damage (bytes that are not those of the build; the first), tile
// (cannot be decoded, or is another one's), link (to a segment that is not in the map, or does not
// begin where the other ends), line (whose lengths are not those of its vertices),
// malformed_record (of the mapping). Empty for a sound map.
std::vector<Finding> contradictions_in(const MapReader& map);

}  // namespace milepost
