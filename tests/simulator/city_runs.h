// The recording of a city's drives: light, traffic and driving style of each.
#pragma once

#include <vector>

#include "tests/simulator/city.h"
#include "tests/simulator/runs.h"

namespace milepost::simulator {

// In the order of the city's drives. `length_m` limits each.
std::vector<RunPlan> city_runs(const City& city, double length_m);

}  // namespace milepost::simulator
