// What a simulated camera looks at: flat textured surfaces in a local frame of metres, and a sky.
#pragma once

#include <memory>
#include <vector>

#include <opencv2/core.hpp>

#include "tests/simulator/texture.h"

namespace milepost::simulator {

// Metres east, north and up of the drive's origin.
using Point = cv::Vec3d;

// A rectangle, seen from both sides. The texture's top left corner lies at `top_left`; its columns
// run along `across` and its rows along `down`.
struct Surface {
  Point top_left;
  Point across;  // unit vector
  Point down;    // unit vector, at a right angle to `across`
  double width_m = 0;
  double height_m = 0;
  std::shared_ptr<const Texture> texture;
  cv::Vec2f texels_per_m;  // along `across` and `down`
  float light = 1;         // how bright it lies in the sun
};

struct Scene {
  std::vector<Surface> surfaces;
};

}  // namespace milepost::simulator
