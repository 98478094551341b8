#include "client/fetch/segment_layer.h"

#include <cmath>
#include <utility>

#include "schema/base/json.h"

namespace milepost {

Result<std::shared_ptr<const LayerParameters>> read_layer_parameters(MapSource& source,
                                                                     const MapVersion& version,
                                                                     const std::string& layer) {
  const Result<MapDescription> map = source.describe(version);
  if (!map) return map.error();
  const auto found = map->layers.find(layer);
  if (found == map->layers.end()) {
    return Error{ErrorCode::invalid_input, "map '" + version.map + "'",
                 "it has no layer '" + layer + "', which the method needs",
                 "build it with milepost-mapper build --lab, or use the method milepost"};
  }
  const auto corrupt = [&](const std::string& what) {
    return Error{ErrorCode::corrupt, "map '" + version.map + "', layer '" + layer + "'", what,
                 "build the map anew"};
  };
  const Result<nlohmann::json> parsed = read_json(found->second);
  if (!parsed) return corrupt("its parameters: " + parsed.error().what);
  if (!parsed->is_object()) return corrupt("its parameters are no JSON object");
  const nlohmann::json& json = *parsed;
  const auto named = json.value("items", nlohmann::json());
  const auto items = layer_items_named(named.is_string() ? named.get<std::string>() : "");
  if (!items) return corrupt("its items are unknown");
  const auto focal = json.value("focal_px", nlohmann::json());
  const bool two_numbers =
      focal.is_array() && focal.size() == 2 && focal[0].is_number() && focal[1].is_number();
  if (!two_numbers) return corrupt("focal_px is not two numbers");
  const double focal_px = std::sqrt(focal[0].get<double>() * focal[1].get<double>());
  if (!(focal_px > 0 && std::isfinite(focal_px))) return corrupt("focal_px is out of range");
  const Result<FeatureParameters> feature = feature_parameters_from_json(map->feature_json);
  if (!feature) return feature.error();
  LayerParameters parameters{*items, *feature, focal_px, std::nullopt};
  if (*items == LayerItems::landmarks) {
    const Result<Codebook> codebook =
        Codebook::from_json(json.value("codebook", nlohmann::json()).dump());
    if (!codebook) return corrupt("its codebook: " + codebook.error().what);
    parameters.codebook = *codebook;
  }
  return std::make_shared<const LayerParameters>(std::move(parameters));
}

Result<std::shared_ptr<const SegmentLayer>> read_segment_layer(
    MapSource& source, const SegmentKey& key, const std::string& layer,
    std::shared_ptr<const LayerParameters> parameters) {
  const Result<SegmentDescription> description = source.segment(key.version, key.segment);
  if (!description) return description.error();
  Result<RouteLine> line = RouteLine::from_vertices(description->vertices);
  if (!line) {
    return Error{ErrorCode::corrupt, "map '" + key.version.map + "', segment '" + key.segment + "'",
                 line.error().what, "build the map anew"};
  }
  Result<std::vector<TileEntry>> index = source.tile_index(key.version, key.segment, layer);
  if (!index) return index.error();
  return std::make_shared<const SegmentLayer>(
      SegmentLayer{key, layer, std::move(parameters), std::move(*line), std::move(*index)});
}

}  // namespace milepost
