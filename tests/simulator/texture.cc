#include "tests/simulator/texture.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace milepost::simulator {
namespace {

constexpr float kMaxTaps = 8;  // along a footprint's longer side

cv::Vec3f texel(const cv::Mat& image, int x, int y) { return image.at<cv::Vec3b>(y, x); }

cv::Vec3f bilinear(const cv::Mat& image, float x, float y) {
  const auto right = static_cast<float>(image.cols - 1);
  const auto bottom = static_cast<float>(image.rows - 1);
  x = std::clamp(x - 0.5F, 0.0F, right);
  y = std::clamp(y - 0.5F, 0.0F, bottom);
  const int x0 = static_cast<int>(x);
  const int y0 = static_cast<int>(y);
  const int x1 = std::min(x0 + 1, image.cols - 1);
  const int y1 = std::min(y0 + 1, image.rows - 1);
  const float fx = x - static_cast<float>(x0);
  const float fy = y - static_cast<float>(y0);
  const cv::Vec3f top = texel(image, x0, y0) * (1 - fx) + texel(image, x1, y0) * fx;
  const cv::Vec3f low = texel(image, x0, y1) * (1 - fx) + texel(image, x1, y1) * fx;
  return top * (1 - fy) + low * fy;
}

float length(const cv::Vec2f& v) { return std::hypot(v[0], v[1]); }

}  // namespace

Texture::Texture(const cv::Mat& image) : levels_{image} {
  while (levels_.back().cols > 1 || levels_.back().rows > 1) {
    const cv::Mat& last = levels_.back();
    cv::Mat half;
    cv::resize(last, half, {(last.cols + 1) / 2, (last.rows + 1) / 2}, 0, 0, cv::INTER_AREA);
    levels_.push_back(half);
  }
}

// Anisotropic filtering: the level fits the footprint's shorter side, and several taps stand along
// its longer side.
cv::Vec3f Texture::sample(const cv::Vec2f& place, const Footprint& footprint) const {
  const float column = length(footprint.per_column);
  const float row = length(footprint.per_row);
  const cv::Vec2f along = column > row ? footprint.per_column : footprint.per_row;
  const float longer = std::max({column, row, 1e-3F});
  const float shorter = std::max(std::min(column, row), 1e-3F);
  const float taps = std::clamp(std::ceil(longer / shorter), 1.0F, kMaxTaps);
  const float level = std::log2(std::max(longer / taps, 1.0F));
  cv::Vec3f sum(0, 0, 0);
  for (float tap = 0; tap < taps; ++tap) {
    const float offset = (tap + 0.5F) / taps - 0.5F;
    sum += sample_between_levels(place + along * offset, level);
  }
  return sum / taps;
}

cv::Vec3f Texture::sample_between_levels(const cv::Vec2f& place, float level) const {
  const auto top = static_cast<float>(levels_.size() - 1);
  const float inside = std::min(level, top);
  const auto at_level = [&](std::size_t index) {
    const cv::Mat& image = levels_[index];
    const float scale_x = static_cast<float>(image.cols) / static_cast<float>(levels_[0].cols);
    const float scale_y = static_cast<float>(image.rows) / static_cast<float>(levels_[0].rows);
    return bilinear(image, place[0] * scale_x, place[1] * scale_y);
  };
  const auto fine = static_cast<std::size_t>(inside);
  const float part = inside - static_cast<float>(fine);
  if (part <= 0) return at_level(fine);
  return at_level(fine) * (1 - part) + at_level(fine + 1) * part;
}

}  // namespace milepost::simulator
