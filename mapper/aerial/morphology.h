// Structuring elements for mathematical morphology.
#pragma once

#include <opencv2/core.hpp>

namespace milepost {

// A disc with a radius on the ground, at least one pixel, for OpenCV's morphology.
cv::Mat disc(double radius_m, double metres_per_pixel);

}  // namespace milepost
