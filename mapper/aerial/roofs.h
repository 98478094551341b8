// Classifies the regions of a picture as roofs: by their shape, by the shadow they cast, by the
// colours of the picture's own clearest roofs, and by their neighbours. This is not in the aerial
// paper; decision 21 states its benefit.
#pragma once

#include <array>
#include <vector>

#include <opencv2/core.hpp>

#include "mapper/aerial/regions.h"
#include "mapper/aerial/sun.h"
#include "mapper/aerial/wall_line.h"

namespace milepost {

// The features of a region.
struct RoofFeatures {
  // Shape and shadow, in the order of RoofSettings::shape_weights: ln of its area (m2), the square
  // of that, ln of its width (m), the share of its rectangle that it fills, the share of its
  // outline on straight lines, and how much darker it is outside on the side of its shadow.
  std::array<double, 6> shape{};
  // Appearance: ln of its texture, share of green outside, ln of its contrast to the outside.
  std::array<double, 3> looks{};
};

struct RoofSettings {
  // Log odds that a region is a roof by its shape: a bias, and one weight per feature.
  double shape_bias = -7.5;
  std::array<double, 6> shape_weights = {0.04, -0.21, 2.5, 6.3, 4.3, 1.8};
  double looks_trust = 1;      // weight of the log odds by colour and looks
  double least_roofs = 30;     // number of roofs at which learned looks have half that weight
  double neighbour_trust = 2;  // weight of the mean log odds of neighbours of similar colour
  int rounds = 4;              // of learning looks and of smoothing over neighbours
  double closing_m = 0.3;      // radius of the closing of gaps in a roof
  double opening_m = 1.0;      // radius of the opening that removes narrow roofs
};

// `lines` are the straight edges of the picture.
std::vector<RoofFeatures> roof_features(const RegionMap& map, const WallLines& lines,
                                        const Sun& sun);

// The probability of each region to be a roof.
std::vector<double> roof_probabilities(const RegionMap& map,
                                       const std::vector<RoofFeatures>& features,
                                       const RoofSettings& settings);

// CV_32FC1: the probability at each pixel of the map, after closing and opening; 0 outside of
// regions.
cv::Mat roof_picture(const RegionMap& map, const std::vector<double>& probabilities,
                     const RoofSettings& settings);

// The root mean square over pictures of several scales: a roof that is whole in only one of them
// still counts. REQUIRES: one or more pictures of one size.
cv::Mat over_scales(const std::vector<cv::Mat>& pictures);

struct RoofEdgeSettings {
  double min_difference = 0.3;  // of the mean probability between the two sides of a wall
  double near_m = 0.4;          // from the wall to the begin of its sides
  double far_m = 1.3;           // and to their end
};

// The lines that have a roof on one side only, directed so that it is on the right.
WallLines at_roof_edges(const WallLines& lines, const cv::Mat& roofs, const PixelGrid& grid,
                        const RoofEdgeSettings& settings);

}  // namespace milepost
