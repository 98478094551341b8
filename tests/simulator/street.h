// A street of houses, poles and signs, made up from a seed.
#pragma once

#include <cstdint>

#include "tests/simulator/centreline.h"
#include "tests/simulator/scene.h"

namespace milepost::simulator {

struct StreetPlan {
  double length_m = 120;  // to drive along
  double beyond_m = 80;   // more of the street, to look at, up to the house that closes it
  double heading_deg = 30;
  double curvature_per_m = 1.0 / 900;
  std::uint64_t seed = 1;
};

struct Street {
  StreetPlan plan;
  Centreline line;
  Scene scene;
};

// The same plan gives the same street.
Street make_street(const StreetPlan& plan);

}  // namespace milepost::simulator
