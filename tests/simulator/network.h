// The town's roads, their junctions, and the routes of drives.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/simulator/path.h"
#include "tests/simulator/terrain.h"

namespace milepost::simulator {

// The kind of development along a stretch of road.
enum class Frontage {
  canyon,  // tall houses wall to wall, shops
  avenue,  // houses of two or three floors, front gardens, trees
  narrow,  // lower houses wall to wall
  open,    // fields, few farms
};

struct Stretch {
  double from_m = 0;  // up to the next stretch
  Frontage frontage = Frontage::narrow;
};

struct Road {
  std::string name;
  Path path;                   // its middle
  double half_width_m = 3.25;  // of the carriageway
  double parking_m = 0;        // of that, at either side
  bool has_centre_line = true;
  std::vector<Stretch> stretches;

  Frontage frontage_at(double along_m) const;
};

// Of the kerbstones between a carriageway and its pavement.
inline constexpr double kKerbM = 0.16;
double pavement_width_m(Frontage frontage);

// A point where the carriageway of one road opens onto another's.
struct Mouth {
  std::size_t road = 0;
  double along_m = 0;   // of `road`, at the other road's edge
  double outwards = 1;  // the sign of the change of arc length away from the junction
};

// The line of a route, in the middle of the road; the lane is kLaneM to its right.
struct Route {
  std::string name;
  Path path;
};

inline constexpr double kLaneM = 1.7;

struct Network {
  Terrain terrain;
  std::vector<Road> roads;
  std::vector<Mouth> mouths;
  std::vector<Route> routes;
  cv::Vec2d south_west, north_east;  // the town's bounds

  const Route* route(const std::string& name) const;  // null for an unknown name
};

// The same plan for every seed; the exact positions of roads and the height of the hill differ.
Network make_network(std::uint64_t seed);

}  // namespace milepost::simulator
