// Spatial index of the features of a frame.
#pragma once

#include <cstddef>
#include <vector>

#include "schema/feature/types.h"

namespace milepost {

// The features of one frame by image cell. Holds no reference to them.
class FeatureGrid {
 public:
  explicit FeatureGrid(const std::vector<Feature>& features);
  // Calls visit(index) for every feature in a cell that intersects the circle.
  template <class Visit>
  void visit_near(float x_px, float y_px, float radius_px, Visit visit) const {
    const int first_column = cell_of(x_px - radius_px, columns_);
    const int last_column = cell_of(x_px + radius_px, columns_);
    const int last_row = cell_of(y_px + radius_px, rows_);
    for (int row = cell_of(y_px - radius_px, rows_); row <= last_row; ++row) {
      for (int column = first_column; column <= last_column; ++column) {
        for (const std::size_t index : cells_[row * columns_ + column]) visit(index);
      }
    }
  }

 private:
  static int cell_of(float position_px, int count);

  int columns_ = 1;
  int rows_ = 1;
  std::vector<std::vector<std::size_t>> cells_;
};

}  // namespace milepost
