// Selects the request that brings missing cells and no others.
#pragma once

#include <optional>
#include <set>
#include <vector>

#include "schema/base/cell_grid.h"
#include "schema/base/result.h"
#include "schema/store/map_store.h"

namespace milepost {

struct CellRequest {
  std::optional<Bounds> box;        // none: a single cell, requested by its own URL
  std::vector<CellEntry> expected;  // the cells that the response must consist of, in this order
};

// The request for a rectangle of the grid with the first missing cell in its south-west corner and
// without cells of `index` that are not missing: a moving vehicle misses the rows and columns ahead
// of it. REQUIRES: `missing` (cell numbers) is not empty and contained in `index`, which is
// ascending.
CellRequest request_for_first_block(const std::vector<CellEntry>& index,
                                    const std::set<std::uint32_t>& missing);

// Errors: invalid_input for an invalid box.
Status check_area_query(const Bounds& box);

}  // namespace milepost
