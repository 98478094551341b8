// A z-buffer: the front surface at each sample of a picture.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "tests/simulator/projection.h"

namespace milepost::simulator {

class Raster {
 public:
  static constexpr std::int32_t kNothing = -1;

  // Each pixel has `samples_per_side` squared samples, spread evenly.
  Raster(const cv::Size& size_px, int samples_per_side);

  // Records the samples at which the surface is in front of all that was added before. Where its
  // texture is cut out, the share of a pixel's samples is the texture's opacity.
  void add(const SeenSurface& seen, bool is_pinhole, std::int32_t index);

  std::int32_t front(int column, int row) const { return front_[at(column, row)]; }
  float nearness(int column, int row) const { return nearness_[at(column, row)]; }
  // All samples, row by row; the raster is empty afterwards.
  std::vector<float> take_nearness() { return std::move(nearness_); }
  int columns() const { return columns_; }
  int rows() const { return rows_; }

 private:
  std::size_t at(int column, int row) const {
    return static_cast<std::size_t>(row) * columns_ + column;
  }
  double pixel(double sample) const { return (sample + 0.5) / per_side_ - 0.5; }

  template <class Covers>
  void add_span(const SeenSurface& seen, std::int32_t index, int row, int from, int end,
                Covers covers);

  int per_side_;
  int columns_, rows_;
  std::vector<std::int32_t> front_;
  std::vector<float> nearness_;
};

}  // namespace milepost::simulator
