// Resolves the names in a path; blocks while a map is read from its file. Errors of all:
// invalid_input (the name is malformed), not_found, and for a build also gone.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "server/catalog/catalog.h"

namespace milepost::server {

Result<std::shared_ptr<const ServedMap>> find_map(const Catalog& catalog, const std::string& name);

// The map of a build, if that is the current one or was until a short time ago.
Result<std::shared_ptr<const ServedMap>> find_build(const Catalog& catalog, const std::string& name,
                                                    const std::string& build);

// The map of a build that the server still has: as find_build, or one of the directory's older
// builds.
Result<std::shared_ptr<const ServedMap>> find_kept_build(const Catalog& catalog,
                                                         const std::string& name,
                                                         const std::string& build);

// The results below live as long as `map`.
Result<const ServedSegment*> find_segment(const ServedMap& map, const std::string& id);
Result<const std::vector<TileEntry>*> find_layer(const ServedSegment& segment,
                                                 const std::string& layer);
Result<const TileEntry*> find_tile(const std::vector<TileEntry>& tiles, const std::string& index);
Result<const std::vector<CellEntry>*> find_cells(const ServedMap& map, const std::string& layer);
Result<const CellEntry*> find_cell(const std::vector<CellEntry>& cells, const std::string& number);

}  // namespace milepost::server
