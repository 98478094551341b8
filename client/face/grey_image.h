// A user's image as the library looks at it.
#pragma once

#include <milepost/camera.h>
#include <milepost/image.h>
#include <milepost/result.h>

#include <opencv2/core/mat.hpp>

namespace milepost::vehicle {

// 8-bit grey; of a grey image a view of the user's own pixels.
// Errors: invalid_input (no image, or one of another size than the camera's).
Result<cv::Mat> grey_image(const ImageView& image, const Camera& camera);

}  // namespace milepost::vehicle
