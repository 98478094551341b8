// Trees, hedges and garden walls of a town.
#pragma once

#include <cstdint>

#include "tests/simulator/scene.h"
#include "tests/simulator/site.h"

namespace milepost::simulator {

// Trees along streets, on the roundabout, in yards and fields; hedges and walls of front gardens.
void plant(Scene& scene, const Site& site, std::uint64_t seed);

}  // namespace milepost::simulator
