#include "mapper/aerial/edge_maps.h"

#include <opencv2/imgproc.hpp>

namespace milepost {
namespace {

constexpr double kSobelGain = 8;      // of OpenCV's 3 x 3 Sobel operator, to grey values per pixel
constexpr double kGradientGain = 16;  // of Gradient

// Where the picture has data within two metres.
cv::Mat far_from_gaps(const Picture& picture) {
  const int reach = 2 * static_cast<int>(2.0 / picture.grid.metres_per_pixel) + 1;
  cv::Mat inside;
  cv::erode(picture.covered, inside, cv::Mat::ones(reach, reach, CV_8UC1), {-1, -1}, 1,
            cv::BORDER_CONSTANT, cv::Scalar::all(255));
  return inside;
}

}  // namespace

Gradient gradient_of(const Picture& picture, const EdgeSettings& settings) {
  cv::Mat smooth;
  cv::GaussianBlur(picture.bgr, smooth, {}, settings.smoothing_m / picture.grid.metres_per_pixel);
  std::vector<cv::Mat> channels;
  cv::split(smooth, channels);
  Gradient strongest;
  cv::Mat strength;
  for (const cv::Mat& channel : channels) {
    cv::Mat x, y, x_float, y_float, length;
    cv::Sobel(channel, x, CV_16S, 1, 0, 3, kGradientGain / kSobelGain);
    cv::Sobel(channel, y, CV_16S, 0, 1, 3, kGradientGain / kSobelGain);
    x.convertTo(x_float, CV_32F);
    y.convertTo(y_float, CV_32F);
    cv::magnitude(x_float, y_float, length);
    if (strength.empty()) {
      strongest = {x, y};
      strength = length;
      continue;
    }
    const cv::Mat stronger = length > strength;
    x.copyTo(strongest.x, stronger);
    y.copyTo(strongest.y, stronger);
    length.copyTo(strength, stronger);
  }
  return strongest;
}

std::vector<cv::Mat> edge_maps(const Picture& picture, const Gradient& gradient,
                               const EdgeSettings& settings) {
  const cv::Mat inside = far_from_gaps(picture);
  std::vector<cv::Mat> maps;
  for (const double high_per_m : settings.high_per_m) {
    const double high = high_per_m * picture.grid.metres_per_pixel * kGradientGain;
    cv::Mat edges;
    cv::Canny(gradient.x, gradient.y, edges, settings.low_share * high, high, true);
    maps.push_back(edges & inside);
  }
  return maps;
}

}  // namespace milepost
