// Selects the request that brings missing tiles with as few others as possible.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "schema/base/range.h"
#include "schema/store/map_store.h"

namespace milepost {

struct TileRequest {
  std::optional<AlongRange> range;  // none: a single tile, requested by its own URL
  std::vector<TileEntry> expected;  // the tiles that the response must consist of, in this order
};

// The request for the first run of missing tiles that are adjacent in `index`. REQUIRES: `missing`
// (tile indices) is not empty and contained in `index`, which is ascending.
TileRequest request_for_first_run(const std::vector<TileEntry>& index,
                                  const std::set<std::uint32_t>& missing);

}  // namespace milepost
