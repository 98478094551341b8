// Extracts straight lines from edge maps, the longest first: a progressive probabilistic Hough
// transform (Matas et al., 2000) with the aerial paper's modifications (section II, figure 2).
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "mapper/aerial/edge_maps.h"

namespace milepost {

struct HoughSettings {
  double longest_m = 12;        // least length of a line in the first round
  double shortest_m = 1.5;      // and in the last
  int rounds = 6;               // the length falls by equal ratios between them
  double min_support = 0.6;     // share of a line's length that has an edge; its votes, too
  double max_gap_m = 0.5;       // along a line without an edge
  double corridor_m = 0.1;      // to either side of a line, for its edges
  double max_turn_deg = 20;     // between a line and the edge at one of its points
  double clearance_m = 0.2;     // to either side of a line, in which edges are removed
  double density_window_m = 2;  // where the share of edge pixels is counted
  double dense_share = 0.12;    // above this share, a line must be longer in proportion
  std::uint64_t seed = 1;       // of the order in which edges vote
};

// Between two points in pixels of the maps.
struct PixelLine {
  Eigen::Vector2d begin_px;
  Eigen::Vector2d end_px;
};

// Each round processes the maps in their order. An edge votes for lines of its own orientation.
// A line that is found removes the edges near it from all maps, so no second line lies on it.
// Deterministic. Safe from several threads. REQUIRES: one to seven maps of one size, the loosest
// last; `gradient` is of the picture of the maps.
std::vector<PixelLine> progressive_hough(const std::vector<cv::Mat>& maps, const Gradient& gradient,
                                         double metres_per_pixel, const HoughSettings& settings);

// OpenCV's transform of one map, for comparison: the same least length, gap and support.
std::vector<PixelLine> plain_hough(const cv::Mat& map, double metres_per_pixel,
                                   const HoughSettings& settings);

}  // namespace milepost
