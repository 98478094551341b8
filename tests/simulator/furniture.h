// What stands in the street: lamps, signs, bins, bollards, columns.
#pragma once

#include "tests/simulator/scene.h"

namespace milepost::simulator {

// A place beside a road: on the ground, with the road's direction and the side that faces it.
struct Standing {
  Point foot;
  cv::Vec2d forward;  // unit vector along the road
  cv::Vec2d to_road;  // unit vector across, towards the road
};

void add_lamp(Scene& scene, const Standing& at, cv::RNG& random);
void add_traffic_sign(Scene& scene, const Standing& at, cv::RNG& random);
void add_column(Scene& scene, const Standing& at, cv::RNG& random);  // with posters
void add_bin(Scene& scene, const Standing& at, cv::RNG& random);
void add_bollard(Scene& scene, const Standing& at, cv::RNG& random);
void add_cabinet(Scene& scene, const Standing& at, cv::RNG& random);  // for switchgear

}  // namespace milepost::simulator
