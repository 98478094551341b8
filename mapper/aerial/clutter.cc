#include "mapper/aerial/clutter.h"

#include <cmath>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "mapper/aerial/morphology.h"

namespace milepost {
namespace {

constexpr double kHarris = 0.04;  // k of Harris and Stephens (1988)

int odd_pixels(double width_m, double metres_per_pixel) {
  return 2 * static_cast<int>(std::lround(width_m / metres_per_pixel / 2)) + 1;
}

}  // namespace

cv::Mat rough_mask(const cv::Mat& grey, double metres_per_pixel, const ClutterSettings& settings) {
  cv::Mat unit, response, mask;
  grey.convertTo(unit, CV_32F, 1.0 / 255);
  cv::cornerHarris(unit, response, odd_pixels(settings.window_m, metres_per_pixel), 3, kHarris);
  cv::inRange(response, settings.min_response, settings.max_response, mask);
  cv::morphologyEx(mask, mask, cv::MORPH_CLOSE, disc(settings.closing_m, metres_per_pixel));
  cv::morphologyEx(mask, mask, cv::MORPH_OPEN, disc(settings.min_size_m, metres_per_pixel));
  return mask;
}

cv::Mat green_mask(const Picture& picture, const ClutterSettings& settings) {
  std::vector<cv::Mat> bgr;
  cv::Mat smooth;
  cv::blur(picture.bgr, smooth, cv::Size(1, 1) * odd_pixels(0.5, picture.grid.metres_per_pixel));
  smooth.convertTo(smooth, CV_32F);
  cv::split(smooth, bgr);
  const cv::Mat excess = 2 * bgr[1] - bgr[0] - bgr[2];
  const cv::Mat sum = bgr[0] + bgr[1] + bgr[2];
  return excess > settings.min_greenness * sum;
}

cv::Mat within(const cv::Mat& mask, double metres_per_pixel, const ClutterSettings& settings) {
  cv::Mat inner;
  cv::erode(mask, inner, disc(settings.border_m, metres_per_pixel));
  return inner;
}

}  // namespace milepost
