#include "client/vanishing/line_segments.h"

#include <algorithm>

#include <opencv2/imgproc.hpp>

namespace milepost {

std::vector<LineSegment> line_segments(const cv::Mat& gray, double min_length_px) {
  std::vector<cv::Vec4f> ends_px;
  cv::createLineSegmentDetector(cv::LSD_REFINE_STD)->detect(gray, ends_px);
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
