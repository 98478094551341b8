#include "client/localize/segment_session.h"

#include <cmath>

#include <nlohmann/json.hpp>

namespace milepost {
namespace {

struct LayerParameters {
  TrackletItems items = TrackletItems::tracklets;
  double focal_px = 0;  // geometric mean
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
  const auto json = nlohmann::json::parse(found->second, nullptr, false);
  if (!json.is_object()) return corrupt("its parameters are no JSON object");
  const auto items = json.value("items", nlohmann::json());
  if (items != "tracklets" && items != "observations") return corrupt("its items are unknown");
  const auto focal = json.value("focal_px", nlohmann::json());
  const bool two_numbers =
      focal.is_array() && focal.size() == 2 && focal[0].is_number() && focal[1].is_number();
  if (!two_numbers) return corrupt("focal_px is not two numbers");
  const double focal_px = std::sqrt(focal[0].get<double>() * focal[1].get<double>());
  if (!(focal_px > 0 && std::isfinite(focal_px))) return corrupt("focal_px is out of range");
  return LayerParameters{
      items == "observations" ? TrackletItems::observations : TrackletItems::tracklets, focal_px};
}

}  // namespace

Result<SegmentSession> open_session(const std::shared_ptr<MapSource>& source,
                                    const MapVersion& version, const std::string& segment,
                                    const std::string& layer, const WindowSettings& settings) {
  const Result<MapDescription> map = source->describe(version);
  if (!map) return map.error();
  const Result<LayerParameters> parameters = parameters_of_layer(*map, layer);
  if (!parameters) return parameters.error();
  const Result<FeatureParameters> feature = feature_parameters_from_json(map->feature_json);
  if (!feature) return feature.error();
  const Result<SegmentDescription> description = source->segment(version, segment);
  if (!description) return description.error();
  Result<RouteLine> line = RouteLine::from_vertices(description->vertices);
  if (!line) {
    return Error{ErrorCode::corrupt, "map '" + version.map + "', segment '" + segment + "'",
                 line.error().what, "build the map anew"};
  }
  return SegmentSession{
      version,
      segment,
      std::move(*line),
      *feature,
      parameters->focal_px,
      TrackletWindow({source, version, segment, layer}, parameters->items, settings)};
}

}  // namespace milepost
