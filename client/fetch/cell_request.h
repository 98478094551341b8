// Which one request brings missing cells with nothing besides.
#pragma once

#include <optional>
#include <set>
#include <vector>

#include "schema/base/cell_grid.h"
#include "schema/base/result.h"
#include "schema/store/map_store.h"

namespace milepost {

struct CellRequest {
  std::optional<Bounds> box;        // none: the one cell by its own URL
  std::vector<CellEntry> expected;  // what the answer must consist of, in this order
};

// The request for a rectangle of the grid with the first missing cell in its south-west corner and
// with no cell of `index` in it that is not missing: a vehicle that goes on misses the rows and
// columns ahead of it.
// REQUIRES: `missing` (cell numbers) is not empty and all in `index`, which is ascending.
CellRequest request_for_first_block(const std::vector<CellEntry>& index,
                                    const std::set<std::uint32_t>& missing);

// Errors: invalid_input for a box that is none.
Status check_area_query(const Bounds& box);

}  // namespace milepost
