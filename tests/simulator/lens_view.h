// Pictures through a lens, made of finer pictures through a pinhole.
#pragma once

#include <opencv2/core.hpp>

#include "schema/geo/camera.h"

namespace milepost::simulator {

// Safe to use from several threads at once.
class LensView {
 public:
  explicit LensView(const Camera& camera);

  // The pinhole camera whose pictures show all that the lens shows.
  const Camera& pinhole() const { return pinhole_; }
  // What the lens shows of such a picture: each pixel is the mean of what it covers, and black
  // beyond the field of view. A camera without distortion shows the picture itself.
  cv::Mat shown(const cv::Mat& picture) const;

 private:
  Camera camera_;
  Camera pinhole_;
  cv::Mat places_px_;  // CV_32FC2: of each sample in the pinhole's picture
};

}  // namespace milepost::simulator
