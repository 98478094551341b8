#include "tests/simulator/texture.h"

#include <algorithm>
#include <cmath>

#include <opencv2/core/hal/intrin.hpp>
#include <opencv2/imgproc.hpp>

namespace milepost::simulator {
namespace {

constexpr float kMaxTaps = 6;  // along a footprint's longer side

using cv::v_float32x4;

v_float32x4 texel(const uchar* bytes) {
  return cv::v_cvt_f32(cv::v_reinterpret_as_s32(cv::v_load_expand_q(bytes)));
}

// `x` and `y` in the image's own texels.
v_float32x4 bilinear(const cv::Mat& image, float x, float y) {
  x = std::clamp(x - 0.5F, 0.0F, static_cast<float>(image.cols - 1));
  y = std::clamp(y - 0.5F, 0.0F, static_cast<float>(image.rows - 1));
  const int left = static_cast<int>(x);
  const int top = static_cast<int>(y);
  const int step_x = left + 1 < image.cols ? 4 : 0;
  const std::size_t step_y = top + 1 < image.rows ? image.step[0] : 0;
  const uchar* corner = image.ptr(top) + left * 4;
  const v_float32x4 fx = cv::v_setall_f32(x - static_cast<float>(left));
  const v_float32x4 fy = cv::v_setall_f32(y - static_cast<float>(top));
  const v_float32x4 a = texel(corner);
  const v_float32x4 c = texel(corner + step_y);
  const v_float32x4 upper = a + (texel(corner + step_x) - a) * fx;
  const v_float32x4 lower = c + (texel(corner + step_y + step_x) - c) * fx;
  return upper + (lower - upper) * fy;
}

template <class Levels>
v_float32x4 trilinear(const Levels& levels, const cv::Vec2f& place, float level) {
  const float inside = std::min(level, static_cast<float>(levels.size() - 1));
  const auto at_level = [&](std::size_t index) {
    const auto& of = levels[index];
    return bilinear(of.image, place[0] * of.scale_x, place[1] * of.scale_y);
  };
  const auto fine = static_cast<std::size_t>(inside);
  const float part = inside - static_cast<float>(fine);
  const v_float32x4 first = at_level(fine);
  if (part <= 0) return first;
  return first + (at_level(fine + 1) - first) * cv::v_setall_f32(part);
}

float length(const cv::Vec2f& v) { return std::sqrt(v.dot(v)); }

}  // namespace

const std::vector<Texture::Level>& Texture::levels() const {
  std::call_once(pyramid_->painted, [this] {
    cv::Mat image = paint_();
    if (image.channels() == 3) cv::cvtColor(image, image, cv::COLOR_BGR2BGRA);
    const cv::Size full = image.size();
    std::vector<Level>& levels = pyramid_->levels;
    while (true) {
      levels.push_back({image, static_cast<float>(image.cols) / static_cast<float>(full.width),
                        static_cast<float>(image.rows) / static_cast<float>(full.height)});
      if (image.cols == 1 && image.rows == 1) break;
      cv::Mat half;
      cv::resize(image, half, {(image.cols + 1) / 2, (image.rows + 1) / 2}, 0, 0, cv::INTER_AREA);
      image = half;
    }
  });
  return pyramid_->levels;
}

void Texture::forget() const { pyramid_ = std::make_unique<Pyramid>(); }

// Anisotropic filtering: the level matches the footprint's shorter side, with several taps along
// its longer side.
cv::Vec4f Texture::sample(const cv::Vec2f& place, const Footprint& footprint) const {
  const float column = length(footprint.per_column);
  const float row = length(footprint.per_row);
  const cv::Vec2f along = column > row ? footprint.per_column : footprint.per_row;
  const float longer = std::max({column, row, 1e-3F});
  const float shorter = std::max({std::min(column, row), 1.0F, longer / kMaxTaps});
  const float taps = std::clamp(std::ceil(longer / shorter), 1.0F, kMaxTaps);
  const float level = std::log2(std::max(longer / taps, 1.0F));
  const auto& all = levels();
  v_float32x4 sum = cv::v_setzero_f32();
  for (float tap = 0; tap < taps; ++tap) {
    const float offset = (tap + 0.5F) / taps - 0.5F;
    sum += trilinear(all, place + along * offset, level);
  }
  cv::Vec4f mean;
  cv::v_store(mean.val, sum * cv::v_setall_f32(1 / taps));
  return mean;
}

float Texture::opacity(const cv::Vec2f& place, float level) const {
  const auto& all = levels();
  const auto nearest =
      static_cast<std::size_t>(std::clamp(level, 0.0F, static_cast<float>(all.size() - 1)));
  cv::Vec4f colour;
  const Level& of = all[nearest];
  cv::v_store(colour.val, bilinear(of.image, place[0] * of.scale_x, place[1] * of.scale_y));
  return colour[3];
}

}  // namespace milepost::simulator
