// Which regions of a picture are roofs: by their shape, by the shadow they cast, by colours that
// the picture's own clearest roofs have, and by their neighbours. Nothing of it is in the aerial
// paper; decision 21 tells what it is worth.
#pragma once

#include <array>
#include <vector>

#include <opencv2/core.hpp>

#include "mapper/aerial/regions.h"
#include "mapper/aerial/sun.h"
#include "mapper/aerial/wall_line.h"

namespace milepost {

// What is measured of a region.
struct RoofFeatures {
  // Of its shape and shadow, in the order of RoofSettings::shape_weights: ln of its area (m2), the
  // square of that, ln of its width (m), the share of its rectangle that it fills, the share of its
  // outline on straight lines, and how much darker it is outside on the side of its shadow.
  std::array<double, 6> shape{};
  // Of its looks: ln of its texture, share of green outside, ln of its contrast to what is outside.
  std::array<double, 3> looks{};
};

struct RoofSettings {
  // Log odds that a region is a roof by its shape: a bias, and a weight a feature.
  double shape_bias = -7.5;
  std::array<double, 6> shape_weights = {0.04, -0.21, 2.5, 6.3, 4.3, 1.8};
  double looks_trust = 1;      // of the log odds by colour and looks
  double least_roofs = 30;     // looks learned from so many roofs are trusted half as much
  double neighbour_trust = 2;  // of the mean log odds of neighbours of a like colour
  int rounds = 4;              // in which looks are learned and neighbours asked
  double closing_m = 0.3;      // gaps in a roof that are narrower than twice this are closed
  double opening_m = 1.0;      // roofs that are narrower than twice this are none
};

// `lines` are the straight edges of the picture.
std::vector<RoofFeatures> roof_features(const RegionMap& map, const WallLines& lines,
                                        const Sun& sun);

// The probability of each region to be a roof.
std::vector<double> roof_probabilities(const RegionMap& map,
                                       const std::vector<RoofFeatures>& features,
                                       const RoofSettings& settings);

// CV_32FC1: the probability at each pixel of the map, closed and opened; 0 where there is no
// region.
cv::Mat roof_picture(const RegionMap& map, const std::vector<double>& probabilities,
                     const RoofSettings& settings);

// The root of the mean square over pictures of several scales of regions: a roof that is whole in
// one of them counts. REQUIRES: one picture or more, of one size.
cv::Mat over_scales(const std::vector<cv::Mat>& pictures);

struct RoofEdgeSettings {
  double min_difference = 0.3;  // of the mean probability between both sides of a wall
  double near_m = 0.4;          // from the wall, where its sides begin
  double far_m = 1.3;           // and end
};

// The lines that have a roof on one side and none on the other, turned so that it is on the right.
WallLines at_roof_edges(const WallLines& lines, const cv::Mat& roofs, const PixelGrid& grid,
                        const RoofEdgeSettings& settings);

}  // namespace milepost
