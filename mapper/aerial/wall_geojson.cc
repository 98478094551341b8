#include "mapper/aerial/wall_geojson.h"

#include <cmath>

#include <nlohmann/json.hpp>

namespace milepost {
namespace {

using Json = nlohmann::ordered_json;

Json position_of(const WallEnd& end) {
  const auto degrees = [](double value) { return std::round(value * 1e8) / 1e8; };
  return {degrees(end.longitude_deg), degrees(end.latitude_deg)};
}

}  // namespace

std::string geojson_of(const std::vector<Wall>& walls) {
  Json features = Json::array();
  for (const Wall& wall : walls) {
    features.push_back(
        {{"type", "Feature"},
         {"properties", {{"sigma_m", wall.sigma_m}}},
         {"geometry",
          {{"type", "LineString"},
           {"coordinates", Json::array({position_of(wall.begin), position_of(wall.end)})}}}});
  }
  return Json({{"type", "FeatureCollection"}, {"features", features}}).dump(1) + "\n";
}

}  // namespace milepost
