// The geometry of a drive's camera.
#pragma once

#include "schema/drive/drive.h"
#include "schema/geo/camera_pose.h"

namespace milepost {

inline Pinhole pinhole_of(const Camera& camera) {
  return {camera.focal_x_px, camera.focal_y_px, camera.principal_x_px, camera.principal_y_px};
}

}  // namespace milepost
