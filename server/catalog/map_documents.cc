#include "server/catalog/map_documents.h"

#include "schema/base/json.h"

namespace milepost::server {
namespace {

using Json = nlohmann::ordered_json;

Result<Json> parsed_object(const std::string& text, const std::string& where) {
  Result<Json> json = read_ordered_json(text);
  if (!json) return Error{ErrorCode::corrupt, where, json.error().what, "rebuild the map"};
  if (json->is_object()) return json;
  return Error{ErrorCode::corrupt, where, "the parameters are not a JSON object",
               "rebuild the map"};
}

Json bounds_json(const Bounds& bounds) {
  return {{"west_deg", bounds.west_deg},
          {"south_deg", bounds.south_deg},
          {"east_deg", bounds.east_deg},
          {"north_deg", bounds.north_deg}};
}

Json line_json(const std::vector<StoredVertex>& vertices) {
  Json line = Json::array();
  for (const StoredVertex& vertex : vertices) {
    line.push_back({vertex.latitude_deg, vertex.longitude_deg, vertex.altitude_m, vertex.along_m});
  }
  return line;
}

Json tile_json(const TileEntry& tile) {
  return {{"index", tile.index}, {"from_m", tile.along.from_m}, {"to_m", tile.along.to_m},
          {"items", tile.items}, {"bytes", tile.bytes},         {"digest", tile.digest}};
}

Json tiles_json(const std::map<std::string, std::vector<TileEntry>>& layers) {
  Json json = Json::object();
  for (const auto& [layer, tiles] : layers) {
    Json list = Json::array();
    for (const TileEntry& tile : tiles) list.push_back(tile_json(tile));
    json[layer] = std::move(list);
  }
  return json;
}

Json cell_json(const CellEntry& cell) {
  Json json = {{"cell", cell.cell}};
  json.update(bounds_json(GridCell::numbered(cell.cell).bounds()));
  json.update({{"items", cell.items}, {"bytes", cell.bytes}, {"digest", cell.digest}});
  return json;
}

}  // namespace

Result<std::string> map_document(const std::string& name, const MapReader& reader,
                                 double length_m) {
  Json layers = Json::array();
  Json parameters = Json::object();
  for (const auto& [layer, text] : reader.layers()) {
    Result<Json> object = parsed_object(text, reader.file().string() + ", layer " + layer);
    if (!object) return object.error();
    layers.push_back(layer);
    parameters[layer] = std::move(*object);
  }
  Result<Json> feature =
      parsed_object(reader.feature_json(), reader.file().string() + ", feature parameters");
  if (!feature) return feature.error();
  const Json json = {{"name", name},
                     {"build", reader.build()},
                     {"layers", std::move(layers)},
                     {"layer_parameters", std::move(parameters)},
                     {"feature", std::move(*feature)},
                     {"bounds", bounds_json(reader.bounds())},
                     {"segments", reader.segment_ids()},
                     {"length_m", length_m}};
  return json.dump();
}

std::string segment_document(const std::string& map, const std::string& build,
                             const StoredSegment& segment,
                             const std::map<std::string, std::vector<TileEntry>>& tiles) {
  const Json json = {{"map", map},
                     {"build", build},
                     {"segment", segment.id},
                     {"length_m", segment.length_m},
                     {"line", line_json(segment.vertices)},
                     {"successors", segment.successors},
                     {"tiles", tiles_json(tiles)}};
  return json.dump();
}

std::string areas_document(const std::string& map, const std::string& build,
                           const std::map<std::string, std::vector<CellEntry>>& cells) {
  Json layers = Json::object();
  for (const auto& [layer, index] : cells) {
    for (const CellEntry& cell : index) layers[layer].push_back(cell_json(cell));
  }
  const Json json = {{"map", map}, {"build", build}, {"cells", std::move(layers)}};
  return json.dump();
}

}  // namespace milepost::server
