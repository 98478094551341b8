// Poses in a local frame of a recording, placed on the Earth.
#pragma once

#include <Eigen/Geometry>

#include "mapper/import/recording.h"
#include "schema/base/result.h"

namespace milepost {

// The tangent frame of --origin. Errors: invalid_input (it is not given).
Result<LocalFrame> frame_of_origin(const ImportOptions& options);

// The attitude of a camera (x right, y down, z forward) in a tangent frame.
GeoAttitude attitude_of(const Eigen::Isometry3d& enu_from_camera, const LocalFrame& frame);

}  // namespace milepost
