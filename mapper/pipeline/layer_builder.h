// Makes the tiles of one layer of one segment from what the mapper follows along it.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "mapper/pipeline/frame_pipeline.h"
#include "mapper/pipeline/layers.h"
#include "schema/base/bytes.h"
#include "schema/base/result.h"
#include "schema/drive/drive.h"
#include "schema/feature/codebook.h"
#include "schema/geo/route_line.h"
#include "schema/tile/observation.h"

namespace milepost {

// A tile as the map stores it.
struct StoredTile {
  std::uint32_t index = 0;
  AlongRange along;
  std::uint64_t items = 0;
  Bytes frame;
};

// Not safe to use from several threads.
class LayerBuilder {
 public:
  virtual ~LayerBuilder() = default;

  // Takes in the next frame, taken at `along_m`, which is greater than that of the frame before.
  virtual void add_frame(const Frame& /*recorded*/, const ExtractedFrame& /*frame*/,
                         double /*along_m*/) {}
  // Takes in tracks that have ended.
  virtual void add_tracks(const std::vector<Track>& /*tracks*/) {}
  // The tiles that nothing beginning at `along_m` or later belongs to, ascending; each once.
  // Infinity once all was added: then the rest of them.
  // Errors: invalid_input for a tile that holds more than the format allows.
  virtual Result<std::vector<StoredTile>> take_complete(double along_m) = 0;
};

// What all layers of one segment are made with. It outlives their builders.
struct SegmentContext {
  std::string segment;
  Camera camera;
  const RouteLine& line;
  const Codebook& codebook;
  double tile_length_m = 0;
};

std::unique_ptr<LayerBuilder> make_layer_builder(const Layer& layer, const SegmentContext& context);

}  // namespace milepost
