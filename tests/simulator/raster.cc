#include "tests/simulator/raster.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace milepost::simulator {
namespace {

// The columns of a sample row that lie inside a convex outline: [first, second].
std::pair<double, double> span_of(const SeenSurface& seen, double y_px) {
  double left = std::numeric_limits<double>::infinity();
  double right = -left;
  for (int i = 0; i < seen.corner_count; ++i) {
    const cv::Point2d& a = seen.outline[i];
    const cv::Point2d& b = seen.outline[(i + 1) % seen.corner_count];
    if ((a.y <= y_px) == (b.y <= y_px)) continue;
    const double x = a.x + (b.x - a.x) * ((y_px - a.y) / (b.y - a.y));
    left = std::min(left, x);
    right = std::max(right, x);
  }
  return {left, right};
}

}  // namespace

Raster::Raster(const cv::Size& size_px, int samples_per_side)
    : per_side_(samples_per_side),
      columns_(size_px.width * samples_per_side),
      rows_(size_px.height * samples_per_side),
      front_(at(0, rows_), kNothing),
      nearness_(front_.size(), -std::numeric_limits<float>::infinity()) {}

template <class Covers>
void Raster::add_span(const SeenSurface& seen, std::int32_t index, int row, int from, int end,
                      Covers covers) {
  const double y = pixel(row);
  const double first = seen.nearness.at(pixel(from), y);
  const double step = seen.nearness.per_column / per_side_;
  for (int column = from; column < end; ++column) {
    const auto nearness = static_cast<float>(first + step * (column - from));
    const std::size_t place = at(column, row);
    if (nearness <= nearness_[place] || !covers(column, nearness)) continue;
    nearness_[place] = nearness;
    front_[place] = index;
  }
}

void Raster::add(const SeenSurface& seen, bool is_pinhole, std::int32_t index) {
  double top = seen.outline[0].y;
  double bottom = top;
  for (int i = 1; i < seen.corner_count; ++i) {
    top = std::min(top, seen.outline[i].y);
    bottom = std::max(bottom, seen.outline[i].y);
  }
  const auto sample = [this](double px, int end) {  // the first sample at or after a pixel position
    return static_cast<int>(std::clamp(std::ceil((px + 0.5) * per_side_ - 0.5), 0.0, end + 0.0));
  };
  const int end_row = sample(bottom, rows_);
  for (int row = sample(top, rows_); row < end_row; ++row) {
    const double y = pixel(row);
    const auto [left, right] = span_of(seen, y);
    const int from = sample(left, columns_);
    const int end = sample(right, columns_);
    if (!seen.surface->is_cut_out) {
      add_span(seen, index, row, from, end, [](int, float) { return true; });
      continue;
    }
    add_span(seen, index, row, from, end, [&](int column, float nearness) {
      const double x = pixel(column);
      const double depth = is_pinhole ? 1 / nearness : 1;
      const cv::Vec2f place(static_cast<float>(seen.u.at(x, y) * depth),
                            static_cast<float>(seen.v.at(x, y) * depth));
      const double texels = seen.texels_per_px * depth / per_side_;  // from sample to sample
      const auto level = static_cast<float>(std::log2(std::max(texels, 1.0)));
      const int of_pixel = (row % per_side_) * per_side_ + column % per_side_;
      const float threshold =
          255 * (static_cast<float>(of_pixel) + 0.5F) / static_cast<float>(per_side_ * per_side_);
      return seen.surface->texture->opacity(place, level) > threshold;
    });
  }
}

}  // namespace milepost::simulator
