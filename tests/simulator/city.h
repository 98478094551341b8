// A city: roads to be drawn, the graph of junctions and edges that is driven, and the drives.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/simulator/network.h"

namespace milepost::simulator {

enum class JunctionKind { crossing, tee, split, join, exit, roundabout, dead_end, end };
const char* name_of(JunctionKind kind);

struct Junction {
  std::string name;
  JunctionKind kind = JunctionKind::crossing;
  cv::Vec2d at;              // east, north
  double ring_radius_m = 0;  // of the driven circle: a roundabout's, a dead end's
};

// One direction of a road from junction to junction, without the junctions' inside.
struct Edge {
  std::string name;      // ROAD.PIECE and + or -, along or against the road
  std::size_t road = 0;  // of the network
  std::size_t from = 0, to = 0;
  Path middle;                  // of the road, in the direction of driving
  std::vector<double> lanes_m;  // lateral offsets of the lanes' middles, the rightmost first
  bool has_oncoming = false;    // in the lane to the left of the leftmost
  bool is_on_bridge = false;

  // Lanes are counted from 1, from the right; one more than there are is the oncoming one.
  double lane_offset_m(int lane) const { return lanes_m.front() - 2 * kLaneM * (lane - 1); }
};

// A drive's way over one edge.
struct Pass {
  std::size_t edge = 0;
  int lane = 1;
  int lane_between = 0;  // the lane of the middle part, if another
  int extra_rounds = 0;  // around the junction at its end
};

struct CityDrive {
  std::string name;
  std::string says;  // one line of description
  bool is_tour = false;
  std::vector<Pass> passes;
  double skipped_m = 0;   // of the first edge
  double left_out_m = 0;  // of the last edge
};

struct City {
  std::uint64_t seed = 1;
  Network network;  // with a route for each drive, of the drive's name
  std::vector<Junction> junctions;
  std::vector<Edge> edges;
  std::vector<CityDrive> drives;

  std::size_t junction(const std::string& name) const;  // REQUIRES: there is one
};

enum class CityPlan {
  small,
  full,
  fleet,  // the full city's roads, and drives that all go one way
};

// The same plan for every seed; the exact positions and the height of the hill differ.
City make_city(std::uint64_t seed, CityPlan plan);

}  // namespace milepost::simulator
