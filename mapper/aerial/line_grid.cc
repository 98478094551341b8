#include "mapper/aerial/line_grid.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace milepost {
namespace {

std::int64_t key_of(std::int64_t column, std::int64_t row) { return column * 4294967296 + row; }

// Calls `visit` (column, row) for cells that cover the line, some more than once: the line is
// sampled at least every half cell.
template <class Visit>
void for_each_cell(const WallLine& line, double cell_m, Visit visit) {
  const int steps = static_cast<int>(std::ceil(2 * line.length_m() / cell_m)) + 1;
  for (int i = 0; i <= steps; ++i) {
    const Eigen::Vector2d at = (line.begin_m + (line.end_m - line.begin_m) * i / steps) / cell_m;
    visit(static_cast<std::int64_t>(std::floor(at.x())),
          static_cast<std::int64_t>(std::floor(at.y())));
  }
}

}  // namespace

void LineGrid::add(std::size_t number, const WallLine& line) {
  for_each_cell(line, cell_m_, [&](std::int64_t column, std::int64_t row) {
    std::vector<std::size_t>& cell = cells_[key_of(column, row)];
    if (cell.empty() || cell.back() != number) cell.push_back(number);
  });
}

std::vector<std::size_t> LineGrid::near(const WallLine& line) const {
  std::vector<std::size_t> numbers;
  for_each_cell(line, cell_m_, [&](std::int64_t column, std::int64_t row) {
    for (std::int64_t x = column - 2; x <= column + 2; ++x) {
      for (std::int64_t y = row - 2; y <= row + 2; ++y) {
        const auto cell = cells_.find(key_of(x, y));
        if (cell == cells_.end()) continue;
        numbers.insert(numbers.end(), cell->second.begin(), cell->second.end());
      }
    }
  });
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  return numbers;
}

}  // namespace milepost
