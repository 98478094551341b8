#include "schema/document/map_documents.h"

#include "schema/base/json.h"
#include "schema/document/canonical_json.h"

namespace milepost {
namespace {

using nlohmann::json;

Result<json> parameters_object(const std::string& text, const std::string& whose) {
  Result<json> object = read_json(text);
  if (object && object->is_object()) return object;
  return Error{ErrorCode::corrupt, whose,
               object ? "the parameters are not a JSON object" : object.error().what,
               "build the map anew"};
}

json bounds_json(const Bounds& bounds) {
  return {{"west_deg", bounds.west_deg},
          {"south_deg", bounds.south_deg},
          {"east_deg", bounds.east_deg},
          {"north_deg", bounds.north_deg}};
}

json line_json(const std::vector<StoredVertex>& vertices) {
  json line = json::array();
  for (const StoredVertex& vertex : vertices) {
    line.push_back({vertex.latitude_deg, vertex.longitude_deg, vertex.altitude_m, vertex.along_m});
  }
  return line;
}

json successors_json(const std::vector<Successor>& successors) {
  json list = json::array();
  for (const Successor& successor : successors) {
    list.push_back({{"segment", successor.segment}});
    if (!successor.map.empty()) list.back()["map"] = successor.map;
  }
  return list;
}

json passes_json(const std::vector<StoredPass>& passes) {
  json list = json::array();
  for (const StoredPass& pass : passes) {
    list.push_back({{"drive", pass.drive}, {"from_m", pass.from_m}, {"to_m", pass.to_m}});
  }
  return list;
}

void add_position_error(json& segment, const PositionError& error) {
  if (error.sigma_m) segment["position_sigma_m"] = *error.sigma_m;
  if (error.correlation_m) segment["position_correlation_m"] = *error.correlation_m;
  if (error.is_assumed) segment["assumed"] = true;
}

json entry_json(const TileEntry& tile) {
  return {{"index", tile.index}, {"from_m", tile.along.from_m}, {"to_m", tile.along.to_m},
          {"items", tile.items}, {"bytes", tile.bytes},         {"digest", tile.digest}};
}

json entry_json(const CellEntry& cell) {
  json entry = bounds_json(GridCell::numbered(cell.cell).bounds());
  entry["cell"] = cell.cell;
  entry["items"] = cell.items;
  entry["bytes"] = cell.bytes;
  entry["digest"] = cell.digest;
  return entry;
}

// Layers without entries are left out, so that a layer elsewhere does not change a document.
template <class Entry>
json indices_json(const std::map<std::string, std::vector<Entry>>& indices) {
  json layers = json::object();
  for (const auto& [layer, index] : indices) {
    for (const Entry& entry : index) layers[layer].push_back(entry_json(entry));
  }
  return layers;
}

}  // namespace

Result<std::string> map_document(const MapSummary& map) {
  json layers = json::array();
  json parameters = json::object();
  for (const auto& [layer, text] : map.layers) {
    Result<json> object = parameters_object(text, "layer " + layer);
    if (!object) return object.error();
    layers.push_back(layer);
    parameters[layer] = std::move(*object);
  }
  Result<json> feature = parameters_object(map.feature_json, "feature parameters");
  if (!feature) return feature.error();
  json document = {{"layers", std::move(layers)},    {"layer_parameters", std::move(parameters)},
                   {"feature", std::move(*feature)}, {"bounds", bounds_json(map.bounds)},
                   {"segment_count", map.segments},  {"length_m", map.length_m}};
  if (!map.datum.empty()) document["datum"] = map.datum;
  return canonical_json(document);
}

std::string segment_document(const StoredSegment& segment, const TileIndices& tiles) {
  json document = {{"segment", segment.id},
                   {"length_m", segment.length_m},
                   {"line", line_json(segment.vertices)},
                   {"successors", successors_json(segment.successors)},
                   {"passes", passes_json(segment.passes)},
                   {"tiles", indices_json(tiles)}};
  add_position_error(document, segment.position_error);
  return canonical_json(document);
}

std::string areas_document(const CellIndices& cells) {
  return canonical_json({{"cells", indices_json(cells)}});
}

}  // namespace milepost
