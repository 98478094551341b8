#include "schema/document/map_documents.h"

#include "schema/base/json.h"
#include "schema/document/canonical_json.h"

namespace milepost {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxKnownParameters = 16;
constexpr std::size_t kMaxKnownBytes = 65536;

// Parameters in their canonical form. Those of most maps are the same, being the mapper's: the
// latest are kept.
Result<std::string> canonical_parameters(const std::string& text, const std::string& whose) {
  thread_local std::map<std::string, std::string> known;
  if (const auto found = known.find(text); found != known.end()) return found->second;
  const Result<json> object = read_json(text);
  if (!object || !object->is_object()) {
    return Error{ErrorCode::corrupt, whose,
                 object ? "the parameters are not a JSON object" : object.error().what,
                 "build the map anew"};
  }
  std::string canonical = canonical_json(*object);
  if (known.size() >= kMaxKnownParameters) known.clear();
  if (text.size() <= kMaxKnownBytes) known[text] = canonical;
  return canonical;
}

json bounds_json(const Bounds& bounds) {
  return {{"west_deg", bounds.west_deg},
          {"south_deg", bounds.south_deg},
          {"east_deg", bounds.east_deg},
          {"north_deg", bounds.north_deg}};
}

json line_json(const std::vector<StoredVertex>& vertices) {
  json::array_t line;
  line.reserve(vertices.size());
  for (const StoredVertex& vertex : vertices) {
    json::array_t numbers;
    numbers.reserve(4);
    for (const double number :
         {vertex.latitude_deg, vertex.longitude_deg, vertex.altitude_m, vertex.along_m})
      numbers.emplace_back(number);
    line.emplace_back(std::move(numbers));
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
  json entry;
  entry["index"] = tile.index;
  entry["from_m"] = tile.along.from_m;
  entry["to_m"] = tile.along.to_m;
  entry["items"] = tile.items;
  entry["bytes"] = tile.bytes;
  entry["digest"] = tile.digest;
  return entry;
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

// Its members are in the order of their names, as those of canonical_json.
Result<std::string> map_document(const MapSummary& map) {
  const Result<std::string> feature = canonical_parameters(map.feature_json, "feature parameters");
  json layers = json::array();
  std::string parameters;
  for (const auto& [layer, text] : map.layers) {
    const Result<std::string> canonical = canonical_parameters(text, "layer " + layer);
    if (!canonical) return canonical.error();
    layers.push_back(layer);
    if (!parameters.empty()) parameters += ',';
    parameters.append(canonical_json(layer)).append(":").append(*canonical);
  }
  if (!feature) return feature.error();
  std::string document = R"({"bounds":)" + canonical_json(bounds_json(map.bounds));
  if (!map.datum.empty()) document.append(R"(,"datum":)").append(canonical_json(map.datum));
  document.append(R"(,"feature":)").append(*feature);
  document.append(R"(,"layer_parameters":{)").append(parameters).append("}");
  document.append(R"(,"layers":)").append(canonical_json(layers));
  document.append(R"(,"length_m":)").append(canonical_json(map.length_m));
  return document.append(R"(,"segment_count":)").append(canonical_json(map.segments)).append("}");
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
