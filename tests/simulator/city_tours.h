// Tours over what a city's mapping drives mapped.
#pragma once

#include <utility>
#include <vector>

#include "tests/simulator/city.h"

namespace milepost::simulator {

// A way through a junction: the edges before and after it.
using Turn = std::pair<std::size_t, std::size_t>;

// The turns of a drive, in order.
std::vector<Turn> turns_of(const CityDrive& drive);

// Tours that together take each turn that a mapping drive took, and no other, in other lanes where
// there are any. Each is as long as possible, up to 5 km. Without names.
std::vector<CityDrive> tours_over(const City& city);

}  // namespace milepost::simulator
