#include "schema/feature/feature_grid.h"

#include <algorithm>

namespace milepost {
namespace {

constexpr float kCellPx = 32;

}  // namespace

FeatureGrid::FeatureGrid(const std::vector<Feature>& features) {
  for (const Feature& feature : features) {
    columns_ = std::max(columns_, static_cast<int>(feature.x_px / kCellPx) + 1);
    rows_ = std::max(rows_, static_cast<int>(feature.y_px / kCellPx) + 1);
  }
  cells_.resize(static_cast<std::size_t>(columns_) * rows_);
  for (std::size_t i = 0; i < features.size(); ++i) {
    const int row = cell_of(features[i].y_px, rows_);
    cells_[row * columns_ + cell_of(features[i].x_px, columns_)].push_back(i);
  }
}

int FeatureGrid::cell_of(float position_px, int count) {
  return static_cast<int>(std::clamp(position_px / kCellPx, 0.0F, static_cast<float>(count - 1)));
}

}  // namespace milepost
