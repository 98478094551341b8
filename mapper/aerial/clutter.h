// Masks of clutter: textured areas that are neither wall nor roof, such as trees, hedges, grass and
// heaps (the aerial paper, section II).
#pragma once

#include <opencv2/core.hpp>

#include "mapper/aerial/orthoimage.h"

namespace milepost {

struct ClutterSettings {
  double window_m = 0.7;        // of the corner detector
  double min_response = 1e-4;   // Harris' R of grey values 0 to 1 per pixel: clutter is from here
  double max_response = 1;      // to here
  double closing_m = 0.4;       // gaps narrower than twice this are closed
  double min_size_m = 2.0;      // radius of the opening that removes small clutter
  double min_greenness = 0.08;  // (2 G - R - B) / (R + G + B) of vegetation
  double border_m = 0.4;        // of vegetation, in which edges are kept: walls may be there
};

// CV_8UC1, 255 where the corner response is in the range of clutter. REQUIRES: `grey` is CV_8UC1.
cv::Mat rough_mask(const cv::Mat& grey, double metres_per_pixel, const ClutterSettings& settings);

// CV_8UC1, 255 where the picture is green; all 0 for a grey picture.
cv::Mat green_mask(const Picture& picture, const ClutterSettings& settings);

// The mask without its border.
cv::Mat within(const cv::Mat& mask, double metres_per_pixel, const ClutterSettings& settings);

}  // namespace milepost
