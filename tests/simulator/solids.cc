#include "tests/simulator/solids.h"

#include <utility>

#include "tests/simulator/paint.h"

namespace milepost::simulator {

Point Box::corner(int along, int right) const {
  const cv::Vec2d across(forward[1], -forward[0]);
  const cv::Vec2d place = forward * (along * length_m / 2) + across * (right * width_m / 2);
  return centre + Point(place[0], place[1], 0);
}

std::shared_ptr<const Texture> painted(std::function<cv::Mat(cv::RNG&)> paint, std::uint64_t seed) {
  return std::make_shared<Texture>([paint = std::move(paint), seed] {
    cv::RNG random = seeded(seed);
    return paint(random);
  });
}

void add_wall(Scene& scene, const Point& left, const Point& right, double height_m,
              std::shared_ptr<const Texture> texture, const cv::Size& texels) {
  const double width_m = cv::norm(right - left);
  scene.surfaces.push_back(rectangle(left + kUp * height_m, (right - left) * (1 / width_m), -kUp,
                                     width_m, height_m, std::move(texture), texels));
}

void add_box(Scene& scene, const Box& box, const std::shared_ptr<const Texture>& texture,
             double texels_per_m) {
  const std::array<Point, 4> floor = {box.corner(-1, -1), box.corner(-1, 1), box.corner(1, 1),
                                      box.corner(1, -1)};
  const Point top = kUp * box.height_m;
  for (int i = 0; i < 4; ++i) {
    const Point& left = floor[i];
    const Point& right = floor[(i + 1) % 4];
    const Point across = cv::normalize(right - left);
    scene.surfaces.push_back(polygon({left + top, right + top, right, left}, texture,
                                     {left + top, across * texels_per_m, -kUp * texels_per_m}));
  }
  const Point across = cv::normalize(floor[1] - floor[0]);
  const Point down = cv::normalize(floor[0] - floor[3]);
  scene.surfaces.push_back(polygon({floor[3] + top, floor[2] + top, floor[1] + top, floor[0] + top},
                                   texture,
                                   {floor[3] + top, across * texels_per_m, down * texels_per_m}));
}

}  // namespace milepost::simulator
