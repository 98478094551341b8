#include "client/localize/segment_session.h"

#include <cmath>

#include "schema/base/json.h"

namespace milepost {
namespace {

struct LayerParameters {
  LayerItems items = LayerItems::tracklets;
  double focal_px = 0;  // geometric mean
  std::optional<Codebook> codebook = std::nullopt;
};

Result<LayerParameters> parameters_of_layer(const MapDescription& map, const std::string& layer) {
  const auto found = map.layers.find(layer);
  if (found == map.layers.end()) {
    return Error{ErrorCode::invalid_input, "map '" + map.version.map + "'",
                 "it has no layer '" + layer + "', which the method needs",
                 "build it with milepost-mapper build --lab, or use the method milepost"};
  }
  const auto corrupt = [&](const std::string& what) {
    return Error{ErrorCode::corrupt, "map '" + map.version.map + "', layer '" + layer + "'", what,
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
  LayerParameters parameters{*items, focal_px};
  if (*items == LayerItems::landmarks) {
    const Result<Codebook> codebook =
        Codebook::from_json(json.value("codebook", nlohmann::json()).dump());
    if (!codebook) return corrupt("its codebook: " + codebook.error().what);
    parameters.codebook = *codebook;
  }
  return parameters;
}

}  // namespace

Result<SegmentSession> open_session(const LayerSource& layer) {
  const Result<MapDescription> map = layer.source->describe(layer.version);
  if (!map) return map.error();
  const Result<LayerParameters> parameters = parameters_of_layer(*map, layer.layer);
  if (!parameters) return parameters.error();
  const Result<FeatureParameters> feature = feature_parameters_from_json(map->feature_json);
  if (!feature) return feature.error();
  const Result<SegmentDescription> description =
      layer.source->segment(layer.version, layer.segment);
  if (!description) return description.error();
  Result<RouteLine> line = RouteLine::from_vertices(description->vertices);
  if (!line) {
    return Error{ErrorCode::corrupt,
                 "map '" + layer.version.map + "', segment '" + layer.segment + "'",
                 line.error().what, "build the map anew"};
  }
  return SegmentSession{layer,    parameters->items,    std::move(*line),
                        *feature, parameters->focal_px, parameters->codebook};
}

}  // namespace milepost
