// The sky at infinity: blue above a bright horizon, with clouds.
#pragma once

#include <opencv2/core.hpp>

#include "tests/simulator/light.h"

namespace milepost::simulator {

// A panorama. Immutable, so safe to share between threads.
class Sky {
 public:
  explicit Sky(const Light& light);

  // Blue, green, red in [0, 255], seen along a direction of any length.
  cv::Vec3f colour(const Point& direction) const;
  // The colour into which distant objects fade.
  cv::Vec3f haze() const { return haze_; }

 private:
  cv::Mat panorama_;  // CV_8UC3: azimuth from north along a row, elevation from the zenith down
  cv::Vec3f haze_;
};

}  // namespace milepost::simulator
