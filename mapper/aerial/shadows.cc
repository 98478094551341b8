#include "mapper/aerial/shadows.h"

#include <cmath>

#include <opencv2/imgproc.hpp>

#include "mapper/aerial/morphology.h"
#include "schema/geo/geodesy.h"

namespace milepost {
namespace {

// Otsu's threshold: the one that maximizes the variance between the two classes of grey values.
double otsu_threshold(const std::array<double, 256>& histogram) {
  double total = 0;
  double sum = 0;
  for (std::size_t grey = 0; grey < histogram.size(); ++grey) {
    total += histogram[grey];
    sum += static_cast<double>(grey) * histogram[grey];
  }
  double below = 0;
  double sum_below = 0;
  double best = 0;
  double threshold = 0;
  for (std::size_t grey = 0; grey < histogram.size(); ++grey) {
    below += histogram[grey];
    sum_below += static_cast<double>(grey) * histogram[grey];
    if (below <= 0 || below >= total) continue;
    const double apart = sum_below / below - (sum - sum_below) / (total - below);
    const double between = below * (total - below) * apart * apart;
    if (between <= best) continue;
    best = between;
    threshold = static_cast<double>(grey) + 1;
  }
  return threshold;
}

}  // namespace

double shadow_threshold(const std::array<double, 256>& histogram, const ShadowSettings& settings) {
  return settings.dark_share * otsu_threshold(histogram);
}

cv::Mat shadow_mask(const cv::Mat& grey, double threshold, double metres_per_pixel,
                    const ShadowSettings& settings) {
  const cv::Mat dark = grey < threshold;
  cv::Mat shadows;
  cv::morphologyEx(dark, shadows, cv::MORPH_OPEN, disc(settings.min_width_m / 2, metres_per_pixel));
  return shadows;
}

cv::Mat far_borders(const cv::Mat& grey, const cv::Mat& shadows, const Sun& sun,
                    double metres_per_pixel, const ShadowSettings& settings) {
  const cv::Mat reach = disc(settings.reach_m, metres_per_pixel);
  cv::Mat near_border;
  cv::morphologyEx(shadows, near_border, cv::MORPH_GRADIENT, reach);
  cv::Mat smooth, east, south;
  cv::GaussianBlur(grey, smooth, {}, settings.smoothing_m / metres_per_pixel);
  cv::Sobel(smooth, east, CV_32F, 1, 0);
  cv::Sobel(smooth, south, CV_32F, 0, 1);
  cv::Mat steepness;
  cv::magnitude(east, south, steepness);
  const Eigen::Vector2d away = shadow_direction(sun);
  const cv::Mat along_light = east * away.x() - south * away.y();
  const cv::Mat rises = along_light > steepness * std::cos(settings.max_angle_deg * kRadPerDeg);
  return near_border & rises;
}

}  // namespace milepost
