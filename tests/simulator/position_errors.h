// The errors of stated positions, as of a vehicle's positioning.
#pragma once

#include <vector>

#include "tests/simulator/runs.h"
#include "tests/simulator/scene.h"

namespace milepost::simulator {

struct PoseError {
  Point position;  // east, north, up
  double heading_deg = 0;
};

// One for each arc length. With the same seed, the errors are proportional to their sizes.
std::vector<PoseError> draw_errors(const PositionErrors& sizes, const std::vector<double>& alongs_m,
                                   std::uint64_t seed);

}  // namespace milepost::simulator
