// The mapping drives of a city, and the tour that leaves what they mapped.
#pragma once

#include <vector>

#include "tests/simulator/city.h"

namespace milepost::simulator {

// REQUIRES: the full city, or the small one.
std::vector<CityDrive> map_drives(const City& city);
std::vector<CityDrive> small_map_drives(const City& city);

// Six drives and a tour on one way, in turn in either lane. REQUIRES: the full city.
std::vector<CityDrive> fleet_drives(const City& city);
CityDrive fleet_tour(const City& city);

// Takes turns that no drive took, over a road that no drive passed in this direction. Without a
// name. REQUIRES: the full city.
CityDrive strange_tour(const City& city);

}  // namespace milepost::simulator
