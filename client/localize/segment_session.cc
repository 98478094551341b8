#include "client/localize/segment_session.h"

#include <cmath>

#include <nlohmann/json.hpp>

namespace milepost {
namespace {

Error corrupt_layer(const std::string& map, const std::string& layer, const std::string& what) {
  return {ErrorCode::corrupt, "map '" + map + "', layer '" + layer + "'", what,
          "build the map anew"};
}

Result<double> focal_of_layer(const MapDescription& map, const std::string& layer) {
  const auto found = map.layers.find(layer);
  if (found == map.layers.end()) {
    return Error{ErrorCode::invalid_input, "map '" + map.version.map + "'",
                 "it has no layer '" + layer + "', which the method needs",
                 "build it with milepost-mapper build --lab, or use the method milepost"};
  }
  const auto parameters = nlohmann::json::parse(found->second, nullptr, false);
  const auto focal =
      parameters.is_object() ? parameters.value("focal_px", nlohmann::json()) : nlohmann::json();
  const bool two_numbers =
      focal.is_array() && focal.size() == 2 && focal[0].is_number() && focal[1].is_number();
  if (!two_numbers) return corrupt_layer(map.version.map, layer, "focal_px is not two numbers");
  const double focal_px = std::sqrt(focal[0].get<double>() * focal[1].get<double>());
  if (!(focal_px > 0 && std::isfinite(focal_px))) {
    return corrupt_layer(map.version.map, layer, "focal_px is out of range");
  }
  return focal_px;
}

}  // namespace

Result<SegmentSession> open_session(const std::shared_ptr<MapSource>& source,
                                    const MapVersion& version, const std::string& segment,
                                    const std::string& layer, const WindowSettings& settings) {
  const Result<MapDescription> map = source->describe(version);
  if (!map) return map.error();
  const Result<double> focal_px = focal_of_layer(*map, layer);
  if (!focal_px) return focal_px.error();
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
      version,  segment,   std::move(*line),
      *feature, *focal_px, TrackletWindow(source, version, segment, layer, settings)};
}

}  // namespace milepost
