// Objects at the kerbs of a town: parked vehicles, lamps, signs and the like.
#pragma once

#include <cstdint>

#include "tests/simulator/scene.h"
#include "tests/simulator/site.h"

namespace milepost::simulator {

// Cars and vans in the bays of roads that have them.
void park_vehicles(Scene& scene, const Site& site, std::uint64_t seed);

// Lamps along streets, and signs, bins, bollards, cabinets and columns on their pavements.
void furnish_streets(Scene& scene, const Site& site, std::uint64_t seed);

}  // namespace milepost::simulator
