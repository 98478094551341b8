// Predicts where a followed feature appears next, and finds the features of a frame in an area.
#pragma once

#include <vector>

#include "schema/tile/observation.h"

namespace milepost {

struct PredictedPosition {
  float x_px = 0;
  float y_px = 0;
  float motion_px = 0;  // length of the predicted motion from the latest observation
};

// Continues the motion between the track's last two observations to `along_m`. Under straight
// motion towards a fixed point the image motion grows as the inverse of depth, and depth shrinks as
// scale grows. REQUIRES: two observations or more.
PredictedPosition predict_position(const Track& track, double along_m);

// The features of one frame by cells of the image. Holds no reference to them.
class FeatureGrid {
 public:
  explicit FeatureGrid(const std::vector<Feature>& features);
  // Calls visit(index) for every feature in a cell that meets the circle.
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
