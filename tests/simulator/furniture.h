// Street furniture: lamps, signs, bins, bollards, columns.
#pragma once

#include "tests/simulator/scene.h"
#include "tests/simulator/site.h"

namespace milepost::simulator {

void add_lamp(Scene& scene, const Standing& at, cv::RNG& random);
void add_traffic_sign(Scene& scene, const Standing& at, cv::RNG& random);
void add_column(Scene& scene, const Standing& at, cv::RNG& random);  // with posters
void add_bin(Scene& scene, const Standing& at, cv::RNG& random);
void add_bollard(Scene& scene, const Standing& at, cv::RNG& random);
void add_cabinet(Scene& scene, const Standing& at, cv::RNG& random);  // for switchgear

}  // namespace milepost::simulator
