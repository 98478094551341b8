// A feature track reduced to pixel observations, for triangulation and bundle adjustment.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "schema/geo/camera_pose.h"

namespace milepost {

struct PixelObservation {
  std::size_t frame = 0;  // index into the caller's poses
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  double magnification = 1;  // of the pixel's errors, as of a Feature
};

using FeatureTrack = std::vector<PixelObservation>;  // in the order of frames

}  // namespace milepost
