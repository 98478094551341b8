// Bridges: a deck with parapets across a cutting, on two walls.
#pragma once

#include <cstdint>

#include "tests/simulator/network.h"
#include "tests/simulator/scene.h"

namespace milepost::simulator {

void add_bridges(Scene& scene, const Network& network, std::uint64_t ground_seed, int texels_per_m);

}  // namespace milepost::simulator
