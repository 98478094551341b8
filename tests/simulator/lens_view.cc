#include "tests/simulator/lens_view.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace milepost::simulator {
namespace {

constexpr int kSamples = 3;      // of a pixel, on each axis
constexpr double kFiner = 1.25;  // the pinhole's picture than the lens's, in its middle
constexpr float kNowhere = -1e6F;

}  // namespace

LensView::LensView(const Camera& camera) : camera_(camera), pinhole_(camera) {
  pinhole_.lens = Lens();
  if (camera.lens.is_pinhole()) return;
  places_px_ = cv::Mat(kSamples * camera.height_px, kSamples * camera.width_px, CV_32FC2,
                       cv::Scalar::all(kNowhere));
  const auto sample_px = [](int sample) { return (sample + 0.5) / kSamples - 0.5; };
  Eigen::Vector2d low = Eigen::Vector2d::Constant(1e9);
  Eigen::Vector2d high = -low;
  for (int y = 0; y < places_px_.rows; ++y) {
    for (int x = 0; x < places_px_.cols; ++x) {
      const auto seen = camera.pinhole_from_image({sample_px(x), sample_px(y)});
      if (!seen) continue;
      const Eigen::Vector2d finer = kFiner * seen->pinhole_px;
      low = low.cwiseMin(finer);
      high = high.cwiseMax(finer);
      places_px_.at<cv::Vec2f>(y, x) = {static_cast<float>(finer.x()),
                                        static_cast<float>(finer.y())};
    }
  }
  const Eigen::Vector2d begin = (low.array() - 1).floor();
  const Eigen::Vector2d size = (high.array() + 2).ceil().matrix() - begin;
  places_px_ -= cv::Scalar(begin.x(), begin.y());
  Pinhole& view = pinhole_.pinhole;
  view.focal_x_px *= kFiner;
  view.focal_y_px *= kFiner;
  view.principal_x_px = kFiner * view.principal_x_px - begin.x();
  view.principal_y_px = kFiner * view.principal_y_px - begin.y();
  pinhole_.width_px = static_cast<int>(size.x());
  pinhole_.height_px = static_cast<int>(size.y());
}

cv::Mat LensView::shown(const cv::Mat& picture) const {
  if (places_px_.empty()) return picture;
  cv::Mat samples;
  cv::remap(picture, samples, places_px_, cv::noArray(), cv::INTER_LINEAR, cv::BORDER_CONSTANT);
  cv::Mat pixels;
  cv::resize(samples, pixels, {camera_.width_px, camera_.height_px}, 0, 0, cv::INTER_AREA);
  return pixels;
}

}  // namespace milepost::simulator
