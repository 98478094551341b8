// Conversion of the caller's images to grey.
#pragma once

#include <milepost/camera.h>
#include <milepost/image.h>
#include <milepost/result.h>

#include <opencv2/core/mat.hpp>

namespace milepost::vehicle {

// The image in 8-bit grey; for a grey image a view of the caller's pixels. Errors: invalid_input
// (no image data, or a size other than the camera's).
Result<cv::Mat> grey_image(const ImageView& image, const Camera& camera);

}  // namespace milepost::vehicle
