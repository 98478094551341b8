// Shapes by which masks are grown and shrunk.
#pragma once

#include <opencv2/core.hpp>

namespace milepost {

// A disc of a radius on the ground, at least a pixel, as OpenCV's morphology takes it.
cv::Mat disc(double radius_m, double metres_per_pixel);

}  // namespace milepost
