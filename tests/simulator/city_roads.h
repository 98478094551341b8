// The roads and the graph of a city, laid out from a seed.
#pragma once

#include "tests/simulator/city.h"

namespace milepost::simulator {

// Without drives and routes.
City lay_out_city(std::uint64_t seed);
City lay_out_small_city(std::uint64_t seed);

}  // namespace milepost::simulator
