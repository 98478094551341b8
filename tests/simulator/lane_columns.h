// Further columns of a table, as a tour's road and lane.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "schema/base/result.h"

namespace milepost::simulator {

// Appends a comma and `header` to the table's first line, and a comma and a cell to each other.
// REQUIRES: as many cells as rows below the header. Errors: not_found, io.
Status add_columns(const std::filesystem::path& table, const std::string& header,
                   const std::vector<std::string>& cells);

}  // namespace milepost::simulator
