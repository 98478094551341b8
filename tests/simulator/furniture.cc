#include "tests/simulator/furniture.h"

#include "tests/simulator/roof.h"
#include "tests/simulator/solids.h"

namespace milepost::simulator {
namespace {

Point flat(const cv::Vec2d& v) { return {v[0], v[1], 0}; }

// A post of `sides` walls.
void add_post(Scene& scene, const Point& foot, double radius_m, double height_m, int sides,
              const std::shared_ptr<const Texture>& texture) {
  for (int i = 0; i < sides; ++i) {
    const double a = 2 * CV_PI * i / sides;
    const double b = 2 * CV_PI * (i + 1) / sides;
    const Point left = foot + Point(std::cos(a), std::sin(a), 0) * radius_m;
    const Point right = foot + Point(std::cos(b), std::sin(b), 0) * radius_m;
    const Point across = cv::normalize(right - left);
    const Point top = kUp * height_m;
    const double shift = i * cv::norm(right - left);  // the texture runs around the post
    scene.surfaces.push_back(
        polygon({left + top, right + top, right, left}, texture,
                {left + top - across * shift, across * kNearTexelsPerM, -kUp * kNearTexelsPerM}));
  }
}

std::shared_ptr<const Texture> pole(const WallSize& size, cv::RNG& random) {
  return painted([=](cv::RNG& own) { return paint_pole(size, own); }, random.next());
}

}  // namespace

void add_lamp(Scene& scene, const Standing& at, cv::RNG& random) {
  constexpr double kHeightM = 6.2;
  const auto texture = pole({0.5, kHeightM}, random);
  const Point foot = at.foot - kUp * 0.2;
  add_post(scene, foot, 0.08, kHeightM + 0.2, 6, texture);
  const Point head = at.foot + kUp * kHeightM + flat(at.to_road) * 0.75;
  add_box(scene, {head, at.to_road, 1.5, 0.07, 0.07}, texture, kNearTexelsPerM);
  add_box(scene, {head + flat(at.to_road) * 0.75 - kUp * 0.06, at.to_road, 0.7, 0.26, 0.14},
          texture, kNearTexelsPerM);
}

void add_traffic_sign(Scene& scene, const Standing& at, cv::RNG& random) {
  constexpr double kSideM = 0.66;
  const double foot_m = random.uniform(1.9, 2.3);
  add_post(scene, at.foot - kUp * 0.2, 0.04, foot_m + kSideM + 0.2, 5,
           pole({0.25, foot_m + kSideM}, random));
  const auto face =
      painted([](cv::RNG& own) { return paint_traffic_sign(kSideM, own); }, random.next());
  const WallSize size{kSideM, kSideM};
  const Point front = at.foot - flat(at.forward) * 0.06 + kUp * foot_m;
  // The road runs along `forward`; its right is where to_road points to from the left side.
  const Point right(at.forward[1], -at.forward[0], 0);
  add_wall(scene, front - right * (kSideM / 2), front + right * (kSideM / 2), kSideM, face,
           size.texels());
  const Point back = at.foot + flat(at.forward) * 0.06 + kUp * foot_m;
  add_wall(scene, back + right * (kSideM / 2), back - right * (kSideM / 2), kSideM, face,
           size.texels());
}

void add_column(Scene& scene, const Standing& at, cv::RNG& random) {
  const WallSize size{3.6, 2.9};
  const auto posters =
      painted([=](cv::RNG& own) { return paint_garden_wall(size, own); }, random.next());
  add_post(scene, at.foot, 0.58, size.height_m, 14, posters);
}

void add_bin(Scene& scene, const Standing& at, cv::RNG& random) {
  const double height_m = random.uniform(0.9, 1.3);
  const auto texture =
      painted([=](cv::RNG& own) { return paint_metal(0.8, height_m, kNearTexelsPerM, own); },
              random.next());
  add_box(scene, {at.foot, at.forward, 0.62, 0.55, height_m}, texture, kNearTexelsPerM);
}

void add_bollard(Scene& scene, const Standing& at, cv::RNG& random) {
  add_post(scene, at.foot, 0.09, 0.95, 6, pole({0.6, 0.95}, random));
}

void add_cabinet(Scene& scene, const Standing& at, cv::RNG& random) {
  const WallSize size{1.5, random.uniform(1.0, 1.5)};
  const auto texture = painted(
      [=](cv::RNG& own) { return paint_board(size.width_m, size.height_m, kNearTexelsPerM, own); },
      random.next());
  add_box(scene, {at.foot, at.forward, 1.2, 0.4, size.height_m}, texture, kNearTexelsPerM);
}

}  // namespace milepost::simulator
