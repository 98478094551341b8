// A town of roads, houses, trees and vehicles, made up from a seed.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "tests/simulator/building.h"
#include "tests/simulator/network.h"
#include "tests/simulator/render.h"
#include "tests/simulator/scene.h"

namespace milepost::simulator {

// From how near the ground is going to be looked at.
enum class GroundDetail { road, aerial };

struct Town {
  std::uint64_t seed = 1;
  Network network;
  std::vector<Building> buildings;
  Scene scene;
  std::shared_ptr<const SkyView> sky_view;
};

// The same seed gives the same town.
Town make_town(std::uint64_t seed, GroundDetail detail = GroundDetail::road);

// The town under a light: throws its shadows. REQUIRES: the town outlives the lighting.
Lighting light_town(const Town& town, const Light& light);

}  // namespace milepost::simulator
