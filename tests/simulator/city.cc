#include "tests/simulator/city.h"

#include <algorithm>

#include "tests/simulator/city_drives.h"
#include "tests/simulator/city_roads.h"
#include "tests/simulator/city_tours.h"
#include "tests/simulator/city_way.h"

namespace milepost::simulator {

const char* name_of(JunctionKind kind) {
  switch (kind) {
    case JunctionKind::crossing:
      return "crossing";
    case JunctionKind::tee:
      return "tee";
    case JunctionKind::split:
      return "split";
    case JunctionKind::join:
      return "join";
    case JunctionKind::exit:
      return "exit";
    case JunctionKind::roundabout:
      return "roundabout";
    case JunctionKind::dead_end:
      return "dead end";
    case JunctionKind::end:
      break;
  }
  return "end";
}

std::size_t City::junction(const std::string& name) const {
  const auto found = std::find_if(junctions.begin(), junctions.end(),
                                  [&](const Junction& each) { return each.name == name; });
  return static_cast<std::size_t>(found - junctions.begin());
}

City make_city(std::uint64_t seed, CityPlan plan) {
  City city = plan == CityPlan::small ? lay_out_small_city(seed) : lay_out_city(seed);
  std::vector<CityDrive> tours;
  if (plan == CityPlan::fleet) {
    city.drives = fleet_drives(city);
    tours = {fleet_tour(city)};
  } else {
    city.drives = plan == CityPlan::full ? map_drives(city) : small_map_drives(city);
    tours = tours_over(city);
    if (plan == CityPlan::full) tours.push_back(strange_tour(city));
  }
  for (std::size_t i = 0; i < tours.size(); ++i) {
    tours[i].name = "city-" + std::to_string(i + 1) + "-tour";
    city.drives.push_back(tours[i]);
  }
  for (const CityDrive& drive : city.drives) city.network.routes.push_back(route_of(city, drive));
  return city;
}

}  // namespace milepost::simulator
