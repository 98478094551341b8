// Solids from which a town is composed.
#pragma once

#include <memory>

#include "tests/simulator/facade.h"
#include "tests/simulator/scene.h"

namespace milepost::simulator {

// An upright box on the ground.
struct Box {
  Point centre;       // of its floor
  cv::Vec2d forward;  // unit vector east, north, along its length
  double length_m = 1;
  double width_m = 1;
  double height_m = 1;

  // Of the floor, left and right as seen along `forward`.
  Point corner(int along, int right) const;
};

inline const Point kUp(0, 0, 1);

std::shared_ptr<const Texture> painted(std::function<cv::Mat(cv::RNG&)> paint, std::uint64_t seed);

// An upright wall whose foot runs from one point to the other, left to right as viewed.
void add_wall(Scene& scene, const Point& left, const Point& right, double height_m,
              std::shared_ptr<const Texture> texture, const cv::Size& texels);

// Four walls and a lid, each with the upper left part of one texture.
void add_box(Scene& scene, const Box& box, const std::shared_ptr<const Texture>& texture,
             double texels_per_m);

}  // namespace milepost::simulator
