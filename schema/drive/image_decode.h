// The only place where images of users are decoded.
#pragma once

#include <string>

#include <opencv2/core.hpp>

#include "schema/base/result.h"

namespace milepost {

// Decodes the bytes of an image file, `flags` being those of cv::imdecode. Nothing is written to
// standard error for any input. Safe from several threads.
// Errors (`what` begins with a verb, `where` is left to the caller): those of sound_image.
Result<cv::Mat> decoded_image(std::string bytes, int flags);

}  // namespace milepost
