// Builds the layer of the default method: as many landmarks as the size target allows.
#pragma once

#include "mapper/landmarks/landmark_mapper.h"
#include "mapper/landmarks/selection.h"
#include "mapper/pipeline/layer_builder.h"
#include "mapper/tracklets/tile_assembler.h"
#include "schema/tile/landmark.h"

namespace milepost {

class LandmarkLayerBuilder : public LayerBuilder {
 public:
  LandmarkLayerBuilder(const SegmentContext& context, const LandmarkLayerSettings& settings);

  void add_frame(const Frame& recorded, const ExtractedFrame& frame, double along_m) override;
  void add_tracks(const std::vector<Track>& tracks) override;
  Result<std::vector<StoredTile>> take_complete(double along_m) override;

 private:
  Result<StoredTile> stored(std::uint32_t index, const std::vector<MappedLandmark>& landmarks);
  LandmarkTile packed(std::uint32_t index, const std::vector<MappedLandmark>& landmarks) const;

  const SegmentContext& context_;
  LandmarkLayerSettings settings_;
  LandmarkMapper mapper_;
  LandmarkSelector selector_;
  TileAssembler<MappedLandmark> assembler_;
};

}  // namespace milepost
