// A tile of landmarks on each side of zero and near the limits of stored values, and its content as
// text.
#pragma once

#include <string>

#include "schema/tile/landmark.h"

namespace milepost::testing {

// Three landmarks 98 km along a segment. The golden tile holds it: do not change it.
LandmarkTile example_landmarks();

// One line for the tile and one for each landmark; the same text as read_tile.py prints for the
// tile's bytes, if the tile is quantized.
std::string text_of(const LandmarkTile& tile);

}  // namespace milepost::testing
