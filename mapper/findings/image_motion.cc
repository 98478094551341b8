#include "mapper/findings/image_motion.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "schema/geo/geodesy.h"

namespace milepost {
namespace {

constexpr double kWidthPx = 320;

}  // namespace

ImageMotion::ImageMotion(const Camera& camera)
    : scale_(kWidthPx / camera.width_px),
      focal_px_(camera.pinhole.focal_x_px * scale_),
      principal_y_px_(camera.pinhole.principal_y_px * scale_) {}

std::optional<MovedImage> ImageMotion::to(const cv::Mat& gray) {
  const cv::Mat now = horizon_of(gray);
  if (window_.empty()) cv::createHanningWindow(window_, now.size(), CV_32F);
  std::optional<MovedImage> moved;
  if (!before_.empty()) {
    const cv::Point2d shift_px = cv::phaseCorrelate(before_, now, window_);
    cv::Mat difference;
    cv::absdiff(before_, now, difference);
    moved = MovedImage{-std::atan(shift_px.x / focal_px_) * kDegPerRad, cv::mean(difference)[0]};
  }
  before_ = now;
  return moved;
}

cv::Mat ImageMotion::horizon_of(const cv::Mat& gray) const {
  cv::Mat small;
  cv::resize(gray, small, {}, scale_, scale_, cv::INTER_AREA);
  const int middle = static_cast<int>(principal_y_px_);
  const int half = std::max(8, small.rows / 4);
  const int top = std::clamp(middle - half, 0, std::max(0, small.rows - 2 * half));
  cv::Mat band;
  small(cv::Rect(0, top, small.cols, std::min(2 * half, small.rows - top))).convertTo(band, CV_32F);
  return band;
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  double ab = 0;
  double aa = 0;
  double bb = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ab += a[i] * b[i];
    aa += a[i] * a[i];
    bb += b[i] * b[i];
  }
  return aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : 0;
}

}  // namespace milepost
