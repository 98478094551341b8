#include "mapper/aerial/morphology.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace milepost {

cv::Mat disc(double radius_m, double metres_per_pixel) {
  const int radius = std::max(1, static_cast<int>(std::lround(radius_m / metres_per_pixel)));
  return cv::getStructuringElement(cv::MORPH_ELLIPSE, {2 * radius + 1, 2 * radius + 1});
}

}  // namespace milepost
