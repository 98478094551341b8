// Edges of a picture (the aerial paper, section II: Canny's detector at several settings).
#pragma once

#include <vector>

#include <opencv2/core.hpp>

#include "mapper/aerial/orthoimage.h"

namespace milepost {

struct EdgeSettings {
  double smoothing_m = 0.15;  // sigma of the Gaussian before the detector
  // Gradients at which an edge begins, in grey values a metre, one a map; it goes on to `low_share`
  // of that. The strictest first.
  std::vector<double> high_per_m = {120, 70, 40};
  double low_share = 0.4;
};

// The gradient of the picture in grey values a pixel, of the channel where it is the greatest.
struct Gradient {
  cv::Mat x;  // CV_16SC1, sixteenths of a grey value a pixel, to the right
  cv::Mat y;  // the same, down
};

Gradient gradient_of(const Picture& picture, const EdgeSettings& settings);

// One map a setting, CV_8UC1: 255 on an edge, else 0. Nothing is an edge where, or next to where,
// the picture has no data. Safe from several threads.
std::vector<cv::Mat> edge_maps(const Picture& picture, const Gradient& gradient,
                               const EdgeSettings& settings);

}  // namespace milepost
