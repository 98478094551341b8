#include "server/viewer/places.h"

#include <cmath>
#include <vector>

#include <nlohmann/json.hpp>

#include "schema/geo/geodesy.h"
#include "schema/tile/codec.h"

namespace milepost::server {
namespace {

using Json = nlohmann::ordered_json;

double rounded_to(double value, double steps_per_unit) {
  return std::round(value * steps_per_unit) / steps_per_unit;
}
double degrees(double value) { return rounded_to(value, 1e8); }  // about a millimetre
double millimetres(double value_m) { return rounded_to(value_m, 1e3); }

// {"items": their number, NAME: [row of an item, ...]}
template <class Item, class RowOf>
std::string items_document(const char* name, const std::vector<Item>& items, RowOf row_of) {
  const std::size_t shown = std::min(items.size(), kMaxShownItems);
  Json rows = Json::array();
  for (std::size_t i = 0; i < shown; ++i) {
    rows.push_back(row_of(items[i * items.size() / shown]));
  }
  return Json{{"items", items.size()}, {name, std::move(rows)}}.dump();
}

}  // namespace

Result<std::string> landmarks_document(ByteView frame, const RouteLine& line) {
  const Result<LandmarkTile> tile = decode_landmarks(frame);
  if (!tile) return tile.error();
  const LocalFrame origin(line.point_at(tile->origin_m));
  return items_document("landmarks", tile->landmarks, [&](const Landmark& landmark) -> Json {
    const GeoPoint position = origin.geo_from_enu(landmark.position);
    return {degrees(position.latitude_deg),
            degrees(position.longitude_deg),
            millimetres(landmark.position.up_m),
            millimetres(landmark.depth_sigma_m),
            millimetres(landmark.size_m),
            millimetres(landmark.along.from_m),
            static_cast<int>(landmark.observations),
            static_cast<int>(landmark.passes)};
  });
}

Result<std::string> walls_document(ByteView frame) {
  const Result<WallTile> tile = decode_walls(frame);
  if (!tile) return tile.error();
  return items_document("walls", tile->walls, [](const Wall& wall) -> Json {
    return {degrees(wall.begin.latitude_deg), degrees(wall.begin.longitude_deg),
            degrees(wall.end.latitude_deg), degrees(wall.end.longitude_deg),
            millimetres(wall.sigma_m)};
  });
}

}  // namespace milepost::server
