#include "mapper/follow/motion.h"

#include <algorithm>
#include <cmath>

namespace milepost {
namespace {

constexpr float kCellPx = 32;
constexpr double kMaxGrowth = 1.5;  // of depth's inverse between two frames, against noisy scales

}  // namespace

PredictedPosition predict_position(const Track& track, double along_m) {
  const Observation& before = track[track.size() - 2];
  const Observation& latest = track.back();
  const double growth = std::clamp(
      static_cast<double>(latest.feature.scale_px) / before.feature.scale_px, 1.0, kMaxGrowth);
  const double spacing = (along_m - latest.along_m) / (latest.along_m - before.along_m);
  const auto factor = static_cast<float>(spacing * growth * growth);
  const float dx_px = factor * (latest.feature.x_px - before.feature.x_px);
  const float dy_px = factor * (latest.feature.y_px - before.feature.y_px);
  return {latest.feature.x_px + dx_px, latest.feature.y_px + dy_px, std::hypot(dx_px, dy_px)};
}

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
