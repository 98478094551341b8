// A simulated scene: planar textured surfaces in a local frame of metres.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include <opencv2/core.hpp>

#include "tests/simulator/texture.h"

namespace milepost::simulator {

// Metres east, north and up of the drive's origin.
using Point = cv::Vec3d;

// The mapping of a texture on a plane: the texel at a point is ((point - origin) . per_m) in u and
// v.
struct TextureMap {
  Point origin;
  Point u_per_m;
  Point v_per_m;
};

// A convex planar polygon of three or four corners, visible from both sides.
struct Surface {
  std::array<Point, 4> corners;
  int corner_count = 4;
  TextureMap map;
  std::shared_ptr<const Texture> texture;
  Point normal;             // a unit vector, for lighting
  bool is_cut_out = false;  // has holes where the texture is transparent
  float translucency = 0;   // share of the sun that shines through from behind
  float openness = 1;       // share of sky light that reaches it, [0, 1]
  bool is_distant = false;  // too distant to cast or receive shadows
  Point centre;             // of a bounding sphere
  double radius_m = 0;
};

struct Scene {
  std::vector<Surface> surfaces;
};

// A rectangle with its texture's top left corner at `top_left`, its columns along `across` and its
// rows along `down` (orthogonal unit vectors); `size` is the texture's.
Surface rectangle(const Point& top_left, const Point& across, const Point& down, double width_m,
                  double height_m, std::shared_ptr<const Texture> texture, const cv::Size& size);

// A polygon of three or four corners with a given texture map; its normal points to the side from
// which the corners run clockwise.
Surface polygon(const std::vector<Point>& corners, std::shared_ptr<const Texture> texture,
                const TextureMap& map);

}  // namespace milepost::simulator
