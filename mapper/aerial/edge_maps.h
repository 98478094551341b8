// Edges of a picture (the aerial paper, section II: Canny's detector at several settings).
#pragma once

#include <vector>

#include <opencv2/core.hpp>

#include "mapper/aerial/orthoimage.h"

namespace milepost {

struct EdgeSettings {
  double smoothing_m = 0.15;  // sigma of the Gaussian before the detector
  // Upper hysteresis thresholds, in grey values per metre, one per map, the strictest first; the
  // lower one is `low_share` of it.
  std::vector<double> high_per_m = {120, 70, 40};
  double low_share = 0.4;
};

// The gradient of the picture in grey values per pixel, of the channel where it is the greatest.
struct Gradient {
  cv::Mat x;  // CV_16SC1, sixteenths of a grey value per pixel, to the right
  cv::Mat y;  // the same, down
};

Gradient gradient_of(const Picture& picture, const EdgeSettings& settings);

// One map per threshold, CV_8UC1: 255 on an edge, else 0. There are no edges in or next to areas
// without data. Safe from several threads.
std::vector<cv::Mat> edge_maps(const Picture& picture, const Gradient& gradient,
                               const EdgeSettings& settings);

}  // namespace milepost
