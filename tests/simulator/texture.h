// An image on a surface, filtered so that its detail decreases with distance as with a real camera.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include <opencv2/core.hpp>

namespace milepost::simulator {

// The derivative of texture coordinates by pixel, in texels.
struct Footprint {
  cv::Vec2f per_column;
  cv::Vec2f per_row;
};

// An image pyramid (mipmap), painted at the first sample. Safe to share between threads.
class Texture {
 public:
  // Returns an 8-bit BGR or BGRA image, not empty, the same at every call.
  using Paint = std::function<cv::Mat()>;

  explicit Texture(Paint paint) : paint_(std::move(paint)) {}
  explicit Texture(const cv::Mat& image) : paint_([image] { return image; }) {}

  // The mean blue, green, red and opacity, [0, 255], of the footprint of one pixel about (x, y), in
  // texels from the top left corner of the top left texel; outside, the border's colour continues.
  cv::Vec4f sample(const cv::Vec2f& place, const Footprint& footprint) const;

  // The opacity, [0, 255], at a point, as the mean over squares of 2^level texels.
  float opacity(const cv::Vec2f& place, float level) const;

  // Frees the pyramid; it is painted again at the next sample. Not safe while others sample.
  void forget() const;

 private:
  struct Level {
    cv::Mat image;  // CV_8UC4
    float scale_x, scale_y;
  };
  struct Pyramid {
    std::once_flag painted;
    std::vector<Level> levels;
  };

  const std::vector<Level>& levels() const;

  Paint paint_;
  mutable std::unique_ptr<Pyramid> pyramid_ = std::make_unique<Pyramid>();
};

}  // namespace milepost::simulator
