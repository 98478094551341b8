// Spatial index of lines.
#pragma once

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "mapper/aerial/wall_line.h"

namespace milepost {

// Lines, by the caller's numbers, in the square cells that they pass through.
class LineGrid {
 public:
  explicit LineGrid(double cell_m) : cell_m_(cell_m) {}

  void add(std::size_t number, const WallLine& line);

  // The numbers, ascending and without duplicates, of all lines within one cell's width of `line`,
  // and of some farther lines.
  std::vector<std::size_t> near(const WallLine& line) const;

 private:
  double cell_m_;
  std::unordered_map<std::int64_t, std::vector<std::size_t>> cells_;
};

}  // namespace milepost
