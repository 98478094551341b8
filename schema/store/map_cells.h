// Reads a map's table of cells.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "schema/store/map_store.h"
#include "schema/store/sqlite.h"

namespace milepost {

// The map's Database must outlive it. Does not check that a layer exists.
class MapCells {
 public:
  // Errors: corrupt if the map lacks the table.
  static Result<MapCells> of(const sqlite::Database& map);

  // The entries of cells that intersect the box, ascending. Errors: corrupt, io.
  Result<std::vector<CellEntry>> in(const std::string& layer, const Bounds& box);

  // Where a cell's bytes are.
  struct Place {
    std::string digest;
    std::int64_t frame = 0;  // id in the table frames
  };
  // Nothing for a cell that the map does not have. Errors: corrupt, io.
  Result<std::optional<Place>> place_of(const std::string& layer, std::uint32_t number);

 private:
  MapCells(std::string file, sqlite::Statement index, sqlite::Statement cell)
      : file_(std::move(file)), index_(std::move(index)), cell_(std::move(cell)) {}

  std::string file_;
  sqlite::Statement index_;
  sqlite::Statement cell_;
};

}  // namespace milepost
