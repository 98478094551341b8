// The true graph of a city as a file, for tests: junctions, edges and the drives' ways.
#pragma once

#include <filesystem>

#include "schema/base/result.h"
#include "tests/simulator/city.h"

namespace milepost::simulator {

inline constexpr const char* kCityGraphFile = "city-graph.json";

// {"seed", "junctions": [{"name", "kind", "at"}],
//  "edges": [{"name", "road", "from", "to", "length_m", "is_on_bridge", "lanes": [{"lane",
//             "length_m", "line": [place...]}]}],
//  "drives": [{"name", "is_tour", "edges": [name...], "from_m", "to_m"}]}
// A place is [longitude_deg, latitude_deg, altitude_m], WGS84, on the road's surface. A drive's
// metres are those of its first and its last edge between which it drives; lanes are counted from
// the right. Errors: io.
Status write_city_graph(const City& city, const std::filesystem::path& path);

}  // namespace milepost::simulator
