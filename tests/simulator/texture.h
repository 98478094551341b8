// An image on a surface, filtered so that its detail fades with distance as behind a lens.
#pragma once

#include <vector>

#include <opencv2/core.hpp>

namespace milepost::simulator {

// How far the place on the texture moves from one pixel of the picture to the next, in texels.
struct Footprint {
  cv::Vec2f per_column;
  cv::Vec2f per_row;
};

// A pyramid of halved images. Immutable, so safe to share between threads.
class Texture {
 public:
  explicit Texture(const cv::Mat& image);  // 8-bit BGR, not empty

  // The mean colour of the footprint of one pixel about (x, y), in texels from the top left corner
  // of the top left texel; places outside take the border's colour.
  cv::Vec3f sample(const cv::Vec2f& place, const Footprint& footprint) const;

 private:
  cv::Vec3f sample_between_levels(const cv::Vec2f& place, float level) const;

  std::vector<cv::Mat> levels_;
};

}  // namespace milepost::simulator
