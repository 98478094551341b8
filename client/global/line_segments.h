// Detection of straight edges in an image (the aerial paper, section III, first step).
#pragma once

#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "schema/geo/camera.h"

namespace milepost {

// A segment between two points in pixels, x to the right and y down, from the centre of the top
// left pixel. The dark side may be on either side.
struct LineSegment {
  Eigen::Vector2d start_px;
  Eigen::Vector2d end_px;

  double length_px() const { return (end_px - start_px).norm(); }
};

// The segments of at least `min_length_px`, the longest first, from the line segment detector of
// von Gioi et al. (IEEE TPAMI 32, 2010); the paper uses Canny edges and a progressive Hough
// transform. Deterministic. Safe to call from several threads at once. REQUIRES: `gray` is CV_8UC1
// and not empty.
std::vector<LineSegment> line_segments(const cv::Mat& gray, double min_length_px);

// The segments between the same points in the image of the camera's pinhole: edges that a lens
// bends are found in pieces. Those that end beyond its field of view are left out.
std::vector<LineSegment> undistorted(const std::vector<LineSegment>& segments,
                                     const Camera& camera);

}  // namespace milepost
