// Pictures of a scene: through a pinhole camera, and from above.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include <opencv2/core.hpp>

#include "schema/drive/drive.h"
#include "tests/simulator/light.h"
#include "tests/simulator/projection.h"
#include "tests/simulator/scene.h"
#include "tests/simulator/shadow.h"
#include "tests/simulator/sky.h"

namespace milepost::simulator {

// A moving upright box, which casts a shadow.
struct Shade {
  Point centre;       // of its floor
  cv::Vec2d forward;  // a unit vector east, north
  double half_length_m = 0;
  double half_width_m = 0;
  double height_m = 0;
};

// The lighting of a scene. Without a sun each texture keeps its own colours.
struct Lighting {
  Light light;
  std::shared_ptr<const Sky> sky;
  std::shared_ptr<const ShadowMap> shadows;
  std::shared_ptr<const SkyView> sky_view;
  std::function<double(const cv::Vec2d&)> ground_m;  // height of the ground at a position
};

Lighting even_lighting();

// Moving objects, at one instant.
struct Moving {
  std::vector<Surface> surfaces;
  std::vector<Shade> shades;
};

// The 8-bit BGR picture; depends only on the arguments. Each pixel is the mean of its area: edges
// from four samples, textures filtered by the pixel's footprint.
cv::Mat render(const Scene& scene, const Lighting& lighting, const Projection& projection,
               const Moving& moving = {});
cv::Mat render(const Scene& scene, const Lighting& lighting, const Camera& camera, const Pose& pose,
               const Moving& moving = {});

}  // namespace milepost::simulator
