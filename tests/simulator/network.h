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

inline constexpr double kLaneM = 1.7;

// What a route passes over, up to its next span.
struct RouteSpan {
  double from_m = 0;  // along the route
  std::string road;   // the edge of the city's graph, or the junction
  int lane = 1;       // counted from the right edge of the carriageway; 0 in a junction
  bool has_oncoming = true;
  bool is_on_bridge = false;
};

// The line of a route, and the lane's lateral offset to its right.
struct Route {
  std::string name;
  Path path;
  double lane_m = kLaneM;
  std::vector<RouteSpan> spans;  // may be empty

  const RouteSpan& span_at(double along_m) const;  // a plain span if there is none
  // Of the road's surface at a position near the route.
  double height_m(const Terrain& terrain, double along_m, const cv::Vec2d& position) const;
};

// A road on a deck across a cutting in which another road passes.
struct Bridge {
  std::size_t upper = 0, lower = 0;  // roads
  cv::Vec2d south_west, north_east;  // of the ground that the deck's road leaves to the lower one

  bool is_over(const cv::Vec2d& position) const;
};

struct Network {
  Terrain terrain;
  std::vector<Road> roads;
  std::vector<Mouth> mouths;
  std::vector<Route> routes;
  std::vector<Bridge> bridges;
  cv::Vec2d south_west, north_east;  // the town's bounds
  double yards_east_m = -30;         // sheds stand to the east of this

  const Route* route(const std::string& name) const;  // null for an unknown name
};

// The area of the town.
double hectares(const Network& network);

// Adds the mouths of all roads, except where two roads meet at a smaller angle: they part or join.
void add_mouths(Network& network, double least_angle_rad);

// The same plan for every seed; the exact positions of roads and the height of the hill differ.
Network make_network(std::uint64_t seed);

}  // namespace milepost::simulator
