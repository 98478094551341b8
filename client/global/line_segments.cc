#include "client/global/line_segments.h"

#include <algorithm>

#include <opencv2/imgproc.hpp>

namespace milepost {
namespace {

// The scale of the image for the detector. OpenCV's default of 0.8 takes more than twice as long
// for directions that are no better.
constexpr double kScale = 0.6;

}  // namespace

std::vector<LineSegment> line_segments(const cv::Mat& gray, double min_length_px) {
  std::vector<cv::Vec4f> ends_px;
  cv::createLineSegmentDetector(cv::LSD_REFINE_STD, kScale)->detect(gray, ends_px);
  std::vector<LineSegment> segments;
  for (const cv::Vec4f& ends : ends_px) {
    const LineSegment segment{{ends[0], ends[1]}, {ends[2], ends[3]}};
    if (segment.length_px() >= min_length_px) segments.push_back(segment);
  }
  std::stable_sort(segments.begin(), segments.end(),
                   [](const auto& a, const auto& b) { return a.length_px() > b.length_px(); });
  return segments;
}

std::vector<LineSegment> undistorted(const std::vector<LineSegment>& segments,
                                     const Camera& camera) {
  if (camera.lens.is_pinhole()) return segments;
  std::vector<LineSegment> straight;
  for (const LineSegment& segment : segments) {
    const auto start = camera.pinhole_from_image(segment.start_px);
    const auto end = camera.pinhole_from_image(segment.end_px);
    if (start && end) straight.push_back({start->pinhole_px, end->pinhole_px});
  }
  return straight;
}

}  // namespace milepost
