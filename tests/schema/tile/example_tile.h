// A tile with values that encoding preserves exactly, and its content as text.
#pragma once

#include <string>

#include "schema/tile/tracklet.h"

namespace milepost::testing {

// Three tracklets 98 km along a segment. The golden tile holds it: do not change it.
TrackletTile example_tile();

// One line for the tile and one for each tracklet; the same text as read_tile.py prints.
std::string text_of(const TrackletTile& tile);

}  // namespace milepost::testing
