// Shadows, and their edges that do not belong to a building (the aerial paper, section II).
#pragma once

#include <array>

#include <opencv2/core.hpp>

#include "mapper/aerial/orthoimage.h"
#include "mapper/aerial/sun.h"

namespace milepost {

struct ShadowSettings {
  double dark_share = 0.55;   // of Otsu's threshold: darker pixels are in shadow
  double min_width_m = 0.6;   // of a shadow; narrower dark lines are ignored
  double reach_m = 0.3;       // an edge this near a shadow's border belongs to the shadow
  double smoothing_m = 0.3;   // of the gradient over the border
  double max_angle_deg = 30;  // between the gradient of a far border and the light
};

// The grey value below which a pixel is in shadow, from the histogram of 256 grey values. A picture
// without shadows has few pixels below it.
double shadow_threshold(const std::array<double, 256>& histogram, const ShadowSettings& settings);

// CV_8UC1, 255 in shadow, else 0. REQUIRES: `grey` is CV_8UC1.
cv::Mat shadow_mask(const cv::Mat& grey, double threshold, double metres_per_pixel,
                    const ShadowSettings& settings);

// The far borders of shadows, on the ground: where intensity increases over the shadow's border
// away from the light. A border that a building shares with its shadow is not included.
// CV_8UC1, 255 there, else 0.
cv::Mat far_borders(const cv::Mat& grey, const cv::Mat& shadows, const Sun& sun,
                    double metres_per_pixel, const ShadowSettings& settings);

}  // namespace milepost
