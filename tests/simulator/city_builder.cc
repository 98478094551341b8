#include "tests/simulator/city_builder.h"

#include <algorithm>

namespace milepost::simulator {
namespace {

constexpr double kStreetHalfWidthM = 3.4;
constexpr double kOneLaneHalfWidthM = 2.4;
constexpr double kLeastMouthRad = 0.5;

// Offsets of the lanes' middles from the road's, the rightmost first.
std::vector<double> lanes_of(const CityRoad& road) {
  if (road.ways == Ways::both) return {kLaneM};
  if (road.lanes == 1) return {0};
  return {kLaneM, -kLaneM};
}

}  // namespace

std::size_t CityBuilder::add_junction(const std::string& name, JunctionKind kind,
                                      const cv::Vec2d& at, double ring_radius_m) {
  city_.junctions.push_back({name, kind, at, ring_radius_m});
  return city_.junctions.size() - 1;
}

std::size_t CityBuilder::add_road(const CityRoad& road) {
  const bool is_narrow = road.ways == Ways::forwards && road.lanes == 1;
  Road drawn;
  drawn.name = road.name;
  drawn.path = road.path;
  drawn.half_width_m = (is_narrow ? kOneLaneHalfWidthM : kStreetHalfWidthM) + road.parking_m;
  drawn.parking_m = road.parking_m;
  drawn.has_centre_line = !is_narrow;
  drawn.stretches = road.stretches;
  city_.network.roads.push_back(drawn);
  add_edges(road, city_.network.roads.size() - 1);
  return city_.network.roads.size() - 1;
}

void CityBuilder::add_edges(const CityRoad& road, std::size_t index) {
  for (std::size_t i = 0; i + 1 < road.stops.size(); ++i) {
    const RoadStop& from = road.stops[i];
    const RoadStop& to = road.stops[i + 1];
    const std::string name = road.name + "." + std::to_string(i + 1);
    const Path middle =
        road.path.part(from.along_m + from.clear_after_m, to.along_m - to.clear_before_m);
    const bool is_two_way = road.ways == Ways::both;
    city_.edges.push_back(
        {name + "+", index, from.junction, to.junction, middle, lanes_of(road), is_two_way, false});
    if (!is_two_way) continue;
    city_.edges.push_back({name + "-", index, to.junction, from.junction, middle.reversed(),
                           lanes_of(road), true, false});
  }
}

void CityBuilder::add_ring(std::size_t junction, double half_width_m, Frontage frontage) {
  const Junction& at = city_.junctions[junction];
  Road ring;
  ring.name = "roundabout";
  ring.path = Path::circle(at.at, at.ring_radius_m);
  ring.half_width_m = half_width_m;
  ring.has_centre_line = false;
  ring.stretches = {{0, frontage}};
  city_.network.roads.push_back(ring);
}

void CityBuilder::add_bridge(std::size_t upper, std::size_t lower, const Cutting& cutting) {
  const cv::Vec2d half(cutting.half_level_m, cutting.half_floor_m + cutting.slope_m);
  city_.network.bridges.push_back({upper, lower, cutting.centre - half, cutting.centre + half});
  terrain().cutting = cutting;
  for (Edge& edge : city_.edges) edge.is_on_bridge = edge.is_on_bridge || edge.road == upper;
}

City CityBuilder::finish(const cv::Vec2d& south_west, const cv::Vec2d& north_east) {
  city_.network.south_west = south_west;
  city_.network.north_east = north_east;
  city_.network.yards_east_m = south_west[0];
  add_mouths(city_.network, kLeastMouthRad);
  return std::move(city_);
}

}  // namespace milepost::simulator
