// Segmentation of a picture by colour: the graph-based method of Felzenszwalb and Huttenlocher
// (IJCV 59, 2004).
#pragma once

#include <opencv2/core.hpp>

namespace milepost {

struct SegmentationSettings {
  double scale = 60;         // the paper's k: a greater one gives larger regions
  double min_region_m2 = 2;  // smaller ones are merged into a neighbour
};

struct Segmentation {
  cv::Mat labels;  // CV_32SC1, 0 to count - 1
  int count = 0;
};

// Merges neighbours (8-connected) by the distance of their colours; pixels of different kinds are
// never merged. REQUIRES: `lab` is CV_32FC3, `kinds` CV_8UC1 of the same size.
Segmentation segmented(const cv::Mat& lab, const cv::Mat& kinds, double metres_per_pixel,
                       const SegmentationSettings& settings);

}  // namespace milepost
