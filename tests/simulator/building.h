// Houses: walls on a footprint under a roof.
#pragma once

#include <array>
#include <cstdint>

#include <opencv2/core.hpp>

#include "tests/simulator/network.h"
#include "tests/simulator/scene.h"

namespace milepost::simulator {

enum class Roof { gable, gable_to_street, hip, flat };

struct Building {
  // Counter-clockwise from above: front left, front right, back right, back left, as seen from the
  // street.
  std::array<cv::Vec2d, 4> footprint;
  double ground_m = 0;      // of the middle of its front
  double foundation_m = 0;  // depth of its walls below that, on a slope
  double eaves_m = 6;       // above the ground
  double ridge_m = 3;       // above the eaves; unused under a flat roof
  Roof roof = Roof::gable;
  Frontage frontage = Frontage::narrow;
  std::uint64_t seed = 1;

  double height_m() const { return roof == Roof::flat ? eaves_m : eaves_m + ridge_m; }
};

void add_building(Scene& scene, const Building& building);

}  // namespace milepost::simulator
