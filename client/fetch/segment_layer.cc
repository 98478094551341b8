#include "client/fetch/segment_layer.h"

#include <utility>

namespace milepost {

Result<std::shared_ptr<const BuildLayer>> read_build_layer(MapSource& source,
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
  const Result<LayerParameters>& parameters = found->second;
  if (!parameters) {
    Error error = parameters.error();
    error.where = "map '" + version.map + "', layer '" + layer + "'";
    return error;
  }
  if (!map->feature) return map->feature.error();
  return std::make_shared<const BuildLayer>(BuildLayer{*map->feature, *parameters, map->datum});
}

Result<std::shared_ptr<const SegmentLayer>> read_segment_layer(
    MapSource& source, const SegmentKey& key, const std::string& layer,
    std::shared_ptr<const BuildLayer> build) {
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
      SegmentLayer{key, layer, std::move(build), std::move(*line), std::move(*index),
                   description->successors, description->position_error});
}

}  // namespace milepost
