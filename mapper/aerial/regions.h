// The regions of a picture, with features that distinguish roofs from ground.
#pragma once

#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "mapper/aerial/clutter.h"
#include "mapper/aerial/orthoimage.h"
#include "mapper/aerial/segmentation.h"

namespace milepost {

// A point of a region's outline.
struct OutlinePoint {
  Eigen::Vector2d at_px;
  Eigen::Vector2d outward;  // unit, x to the right and y down
};

// A region that is neither green nor in shadow.
struct Region {
  int label = 0;
  double area_m2 = 0;
  double length_m = 0;       // of the smallest enclosing rectangle
  double width_m = 0;        // the same, at most the length
  double texture = 0;        // standard deviation of L
  Eigen::Vector3d mean_lab;  // CIE Lab, L 0 to 100
  std::vector<OutlinePoint> outline;
};

struct RegionSettings {
  double metres_per_pixel = 0.2;
  double min_area_m2 = 4;
  double min_segment_m2 = 2;  // smaller segments join a neighbour
  // Of the segmentation: the finest splits a roof by its shading, the coarsest merges similar
  // roofs, and each roof is whole in one of them.
  std::vector<double> scales = {30, 60, 120, 250};
};

enum PixelKind : std::uint8_t { kLit = 0, kGreen = 1, kDark = 2 };

struct RegionMap {
  PixelGrid grid;
  cv::Mat lab;     // CV_32FC3, smoothed
  cv::Mat kinds;   // CV_8UC1, PixelKind
  cv::Mat labels;  // CV_32SC1
  int label_count = 0;
  std::vector<Region> regions;  // ascending by label
};

// One map per scale, in their order. `shadow_threshold`: grey value below which a pixel is in
// shadow. Safe from several threads.
std::vector<RegionMap> region_maps(const Picture& picture, double shadow_threshold,
                                   const ClutterSettings& clutter, const RegionSettings& settings);

}  // namespace milepost
