// Pictures of a scene through a pinhole camera.
#pragma once

#include <opencv2/core.hpp>

#include "schema/drive/drive.h"
#include "tests/simulator/scene.h"

namespace milepost::simulator {

// Where a camera stands and looks.
struct Pose {
  Point position;
  double heading_deg = 0;  // clockwise from north
  double pitch_deg = 0;    // upwards
  double roll_deg = 0;     // clockwise, as seen from behind the camera
};

// The 8-bit BGR picture; a function of its arguments alone. Each pixel is the mean of what it
// covers: edges from four samples, textures filtered by the pixel's footprint.
cv::Mat render(const Scene& scene, const Camera& camera, const Pose& pose);

}  // namespace milepost::simulator
