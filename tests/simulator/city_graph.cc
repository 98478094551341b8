#include "tests/simulator/city_graph.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "schema/base/file.h"
#include "tests/simulator/sensors.h"

namespace milepost::simulator {
namespace {

using GraphJson = nlohmann::ordered_json;

constexpr double kLineStepM = 1;

double to_decimals(double value, double scale) { return std::round(value * scale) / scale; }

GraphJson place_json(const Terrain& terrain, const cv::Vec2d& at, bool is_on_bridge) {
  const double height_m = is_on_bridge ? terrain.uncut_height_m(at) : terrain.height_m(at);
  const GeoPoint place = geo_from_point({at[0], at[1], height_m});
  return {to_decimals(place.longitude_deg, 1e9), to_decimals(place.latitude_deg, 1e9),
          to_decimals(place.altitude_m, 1e4)};
}

GraphJson lane_json(const Terrain& terrain, const Edge& edge, int lane) {
  const Path path = edge.middle.shifted(edge.lane_offset_m(lane));
  const auto steps = static_cast<int>(std::ceil(path.length_m() / kLineStepM));
  GraphJson line = GraphJson::array();
  for (int i = 0; i <= steps; ++i) {
    const cv::Vec2d at = path.position_at({path.length_m() * i / steps, 0});
    line.push_back(place_json(terrain, at, edge.is_on_bridge));
  }
  return {{"lane", lane}, {"length_m", to_decimals(path.length_m(), 1e4)}, {"line", line}};
}

GraphJson edge_json(const City& city, const Edge& edge) {
  GraphJson lanes = GraphJson::array();
  for (int lane = 1; lane <= static_cast<int>(edge.lanes_m.size()); ++lane) {
    lanes.push_back(lane_json(city.network.terrain, edge, lane));
  }
  return {{"name", edge.name},
          {"road", city.network.roads[edge.road].name},
          {"from", city.junctions[edge.from].name},
          {"to", city.junctions[edge.to].name},
          {"length_m", to_decimals(edge.middle.length_m(), 1e4)},
          {"is_on_bridge", edge.is_on_bridge},
          {"lanes", lanes}};
}

GraphJson drive_json(const City& city, const CityDrive& drive) {
  GraphJson edges = GraphJson::array();
  for (const Pass& pass : drive.passes) edges.push_back(city.edges[pass.edge].name);
  const double last_m = city.edges[drive.passes.back().edge].middle.length_m();
  return {{"name", drive.name},
          {"is_tour", drive.is_tour},
          {"edges", edges},
          {"from_m", to_decimals(drive.skipped_m, 1e4)},
          {"to_m", to_decimals(last_m - drive.left_out_m, 1e4)}};
}

}  // namespace

Status write_city_graph(const City& city, const std::filesystem::path& path) {
  GraphJson junctions = GraphJson::array();
  for (const Junction& junction : city.junctions) {
    junctions.push_back({{"name", junction.name},
                         {"kind", name_of(junction.kind)},
                         {"at", place_json(city.network.terrain, junction.at, false)}});
  }
  GraphJson edges = GraphJson::array();
  for (const Edge& edge : city.edges) edges.push_back(edge_json(city, edge));
  GraphJson drives = GraphJson::array();
  for (const CityDrive& drive : city.drives) drives.push_back(drive_json(city, drive));
  const GraphJson graph = {
      {"seed", city.seed}, {"junctions", junctions}, {"edges", edges}, {"drives", drives}};
  return write_text_file(path, graph.dump() + "\n");
}

}  // namespace milepost::simulator
