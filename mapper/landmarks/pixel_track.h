// What placing a landmark needs of a track: where it was seen from which frame.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "schema/geo/camera_pose.h"

namespace milepost {

struct Sight {
  std::size_t frame = 0;  // index into the poses at hand
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
};

using PixelTrack = std::vector<Sight>;  // in the order of frames

}  // namespace milepost
