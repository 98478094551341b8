// Builds the tiles of one layer of --lab from a stretch's frames and tracks, for each segment that
// is cut from it.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "mapper/pipeline/frame_pipeline.h"
#include "mapper/pipeline/layers.h"
#include "mapper/pipeline/stretch_plan.h"
#include "schema/base/bytes.h"
#include "schema/base/result.h"
#include "schema/drive/drive.h"
#include "schema/feature/pca_projection.h"
#include "schema/tile/observation.h"

namespace milepost {

// An encoded tile with its index entry.
struct BuiltTile {
  std::string segment;
  std::uint32_t index = 0;
  AlongRange along;
  std::uint64_t items = 0;
  Bytes frame;
  std::uint64_t repeated = 0;  // items that two drives or more saw
};

// Not safe to use from several threads.
class LayerBuilder {
 public:
  virtual ~LayerBuilder() = default;

  // Arc lengths are those of the stretch.
  // Adds the next frame. REQUIRES: `along_m` is greater than that of the frame before.
  virtual void add_frame(const Frame& /*recorded*/, const ExtractedFrame& /*frame*/,
                         double /*along_m*/) {}
  // Adds tracks that have ended.
  virtual void add_tracks(const std::vector<Track>& /*tracks*/) {}
  // The tiles to which no item beginning at `along_m` or later belongs, each segment's ascending;
  // each is returned once. Infinity, after all items were added, returns the rest.
  // Errors: invalid_input for a tile that holds more than the format allows.
  virtual Result<std::vector<BuiltTile>> take_complete(double along_m) = 0;
};

// Shared inputs of all layers of one stretch. It outlives their builders.
struct StretchContext {
  Camera camera;
  const std::vector<SegmentCut>& segments;
  const PcaProjection& projection;
  double tile_length_m = 0;
};

// REQUIRES: not a layer of landmarks, which are fused before tiles are built.
std::unique_ptr<LayerBuilder> make_layer_builder(const Layer& layer, const StretchContext& context);

}  // namespace milepost
