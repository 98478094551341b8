// The camera that a CameraInfo describes.
#pragma once

#include <optional>

#include "mapper/import/ros/messages.h"
#include "schema/base/result.h"
#include "schema/geo/camera.h"

namespace milepost::ros {

// Of the image as taken, or as rectified, of its part and in its binning. Nothing for a camera that
// is not calibrated. Errors: invalid_input (a lens that is not known, or is none); `where` is left
// to the caller.
Result<std::optional<Camera>> camera_of(const CameraInfo& info, bool is_rectified);

}  // namespace milepost::ros
