#include "tests/simulator/scene.h"

#include <algorithm>
#include <utility>

namespace milepost::simulator {
namespace {

void enclose(Surface& surface) {
  Point sum(0, 0, 0);
  for (int i = 0; i < surface.corner_count; ++i) sum += surface.corners[i];
  surface.centre = sum * (1.0 / surface.corner_count);
  for (int i = 0; i < surface.corner_count; ++i) {
    surface.radius_m = std::max(surface.radius_m, cv::norm(surface.corners[i] - surface.centre));
  }
}

}  // namespace

Surface rectangle(const Point& top_left, const Point& across, const Point& down, double width_m,
                  double height_m, std::shared_ptr<const Texture> texture, const cv::Size& size) {
  const Point right = across * width_m;
  const Point low = down * height_m;
  return polygon({top_left, top_left + right, top_left + right + low, top_left + low},
                 std::move(texture),
                 {top_left, across * (size.width / width_m), down * (size.height / height_m)});
}

Surface polygon(const std::vector<Point>& corners, std::shared_ptr<const Texture> texture,
                const TextureMap& map) {
  Surface surface;
  surface.corner_count = static_cast<int>(corners.size());
  std::copy(corners.begin(), corners.end(), surface.corners.begin());
  surface.map = map;
  surface.texture = std::move(texture);
  surface.normal = cv::normalize((corners[2] - corners[0]).cross(corners[1] - corners[0]));
  enclose(surface);
  return surface;
}

}  // namespace milepost::simulator
