// A town of roads, houses, trees and vehicles, generated from a seed.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "tests/simulator/building.h"
#include "tests/simulator/network.h"
#include "tests/simulator/render.h"
#include "tests/simulator/scene.h"

namespace milepost::simulator {

// The level of detail of the ground, for the viewing distance.
enum class GroundDetail { road, aerial };

struct Town {
  std::string kind = "town";  // or city
  std::uint64_t seed = 1;
  Network network;
  std::vector<Building> buildings;
  Scene scene;
  std::shared_ptr<const SkyView> sky_view;
};

// The same seed gives the same town.
Town make_town(std::uint64_t seed, GroundDetail detail = GroundDetail::road);

// The town around a network of roads.
Town build_town(const Network& network, std::uint64_t seed,
                GroundDetail detail = GroundDetail::road);

// Computes the town's lighting and shadows. REQUIRES: the town outlives the lighting.
Lighting light_town(const Town& town, const Light& light);

}  // namespace milepost::simulator
