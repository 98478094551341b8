#include "mapper/export/geojson.h"

#include <utility>
#include <vector>

#include "schema/base/json.h"
#include "schema/tile/codec.h"

namespace milepost {
namespace {

using Json = nlohmann::ordered_json;

// Takes features one by one, so that a large map is never held as a tree.
class FeatureCollection {
 public:
  void add(Json coordinates, Json properties) {
    const Json feature = {
        {"type", "Feature"},
        {"geometry", {{"type", "LineString"}, {"coordinates", std::move(coordinates)}}},
        {"properties", std::move(properties)}};
    text_ += features_ == 0 ? "\n" : ",\n";
    text_ += feature.dump();
    ++features_;
  }

  GeoJson finish() && { return {std::move(text_) + "\n]}\n", features_}; }

 private:
  std::string text_ = R"({"type":"FeatureCollection","features":[)";
  std::size_t features_ = 0;
};

Json coordinates_of(const std::vector<StoredVertex>& vertices) {
  Json coordinates = Json::array();
  for (const StoredVertex& vertex : vertices) {
    coordinates.push_back({vertex.longitude_deg, vertex.latitude_deg, vertex.altitude_m});
  }
  return coordinates;
}

Json coordinates_of(const WallEnd& end) { return {end.longitude_deg, end.latitude_deg}; }

// The names that --layer may have, in words.
std::string layers_of(const MapReader& map) {
  std::string names = kSegments;
  for (const auto& [layer, parameters] : map.layers()) names += ", " + layer;
  return names;
}

// What the layer's tiles hold, as its parameters name it (FORMAT.md 2.4).
std::string items_of(const std::string& parameters) {
  const Result<Json> json = read_ordered_json(parameters);
  if (!json || !json->is_object()) return "";
  const auto items = json->find("items");
  return items != json->end() && items->is_string() ? items->get<std::string>() : "";
}

Status check_holds_walls(const MapReader& map, const std::string& layer) {
  const auto found = map.layers().find(layer);
  if (found == map.layers().end()) {
    return Error{ErrorCode::not_found, map.file().string(), "the map has no layer '" + layer + "'",
                 "choose among those that it has: " + layers_of(map)};
  }
  const std::string items = items_of(found->second);
  if (items == "walls") return ok_status();
  return Error{ErrorCode::invalid_input, map.file().string(),
               "the layer '" + layer + "' does not hold walls: its items are '" + items + "'",
               "export a layer of walls, or segments"};
}

}  // namespace

Result<GeoJson> segments_geojson(const MapReader& map) {
  FeatureCollection collection;
  for (const std::string& id : map.segment_ids()) {
    const Result<StoredSegment> segment = map.segment(id);
    if (!segment.ok()) return segment.error();
    if (segment->vertices.size() < 2) {
      return Error{ErrorCode::corrupt, map.file().string() + ", segment " + id,
                   "a line has two vertices or more", "build the map anew"};
    }
    collection.add(
        coordinates_of(segment->vertices),
        {{"id", id}, {"length_m", segment->length_m}, {"successors", segment->successors}});
  }
  return std::move(collection).finish();
}

Result<GeoJson> walls_geojson(const MapReader& map, const std::string& layer) {
  const Status checked = check_holds_walls(map, layer);
  if (!checked.ok()) return checked.error();
  const Result<std::vector<CellEntry>> cells = map.cell_index(layer);
  if (!cells.ok()) return cells.error();
  std::vector<WallTile> tiles;
  for (const CellEntry& entry : *cells) {
    const Result<Bytes> frame = map.cell(layer, entry.cell);
    if (!frame.ok()) return frame.error();
    Result<WallTile> tile = decode_walls(*frame);
    if (!tile.ok()) {
      return Error{
          ErrorCode::corrupt,
          map.file().string() + ", layer " + layer + ", cell " + std::to_string(entry.cell),
          tile.error().what, tile.error().mend};
    }
    tiles.push_back(std::move(*tile));
  }
  FeatureCollection collection;
  for (const Wall& wall : walls_of(tiles)) {
    collection.add({coordinates_of(wall.begin), coordinates_of(wall.end)},
                   {{"sigma_m", wall.sigma_m}});
  }
  return std::move(collection).finish();
}

}  // namespace milepost
