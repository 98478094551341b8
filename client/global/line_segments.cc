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

}  // namespace milepost
