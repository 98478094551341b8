// Composes a city's graph from roads that stop at junctions.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "tests/simulator/city.h"

namespace milepost::simulator {

// Where a road meets a junction. An edge begins and ends `clear_m` before the place.
struct RoadStop {
  std::size_t junction = 0;
  double along_m = 0;
  double clear_before_m = 12;
  double clear_after_m = 12;
};

enum class Ways { both, forwards };

struct CityRoad {
  std::string name;
  Path path;
  Ways ways = Ways::both;
  int lanes = 1;  // in each direction
  std::vector<Stretch> stretches;
  double parking_m = 0;
  std::vector<RoadStop> stops;  // in the order along the road
};

class CityBuilder {
 public:
  explicit CityBuilder(std::uint64_t seed) { city_.seed = seed; }

  Terrain& terrain() { return city_.network.terrain; }

  std::size_t add_junction(const std::string& name, JunctionKind kind, const cv::Vec2d& at,
                           double ring_radius_m = 0);
  // Returns the road's index in the network.
  std::size_t add_road(const CityRoad& road);
  // The circle of a roundabout or of a dead end's turning place.
  void add_ring(std::size_t junction, double half_width_m, Frontage frontage);
  // `upper` passes over `lower` at the terrain's cutting.
  void add_bridge(std::size_t upper, std::size_t lower, const Cutting& cutting);

  City finish(const cv::Vec2d& south_west, const cv::Vec2d& north_east);

 private:
  void add_edges(const CityRoad& road, std::size_t index);

  City city_;
};

}  // namespace milepost::simulator
