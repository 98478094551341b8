// One layer of one segment as described by the map's documents.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "client/fetch/map_source.h"
#include "client/fetch/wants.h"
#include "schema/feature/types.h"
#include "schema/geo/route_line.h"
#include "schema/store/map_store.h"
#include "schema/tile/layer_parameters.h"

namespace milepost {

// The parameters common to all segments of a build.
struct BuildLayer {
  FeatureParameters feature;  // of the map's descriptors
  LayerParameters parameters;
  Datum datum = {};  // of the map's positions
};

struct SegmentLayer {
  SegmentKey key;
  std::string name;  // of the layer
  std::shared_ptr<const BuildLayer> build;
  RouteLine line;
  std::vector<TileEntry> index;            // of all its tiles, ascending
  std::vector<Successor> successors = {};  // each with the name of its map
  PositionError position_error = {};       // of the segment

  const std::string& map() const { return key.version.map; }
  const LayerParameters& parameters() const { return build->parameters; }
  const FeatureParameters& feature() const { return build->feature; }
};

// Errors: those of MapSource::describe; invalid_input if the map has no layer of that name;
// corrupt.
Result<std::shared_ptr<const BuildLayer>> read_build_layer(MapSource& source,
                                                           const MapVersion& version,
                                                           const std::string& layer);

// Errors: those of MapSource::segment; corrupt.
Result<std::shared_ptr<const SegmentLayer>> read_segment_layer(
    MapSource& source, const SegmentKey& key, const std::string& layer,
    std::shared_ptr<const BuildLayer> build);

}  // namespace milepost
