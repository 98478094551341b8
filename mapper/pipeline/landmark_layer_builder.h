// Builds the layer of the default method: of each segment as many landmarks as the size target
// allows. Each segment holds all landmarks that were observed from it, so that it needs no other.
#pragma once

#include "mapper/landmarks/landmark_mapper.h"
#include "mapper/landmarks/selection.h"
#include "mapper/pipeline/layer_builder.h"
#include "mapper/tracklets/tile_assembler.h"
#include "schema/tile/landmark.h"

namespace milepost {

class LandmarkLayerBuilder : public LayerBuilder {
 public:
  LandmarkLayerBuilder(const StretchContext& context, const LandmarkLayerSettings& settings);

  void add_frame(const Frame& recorded, const ExtractedFrame& frame, double along_m) override;
  void add_tracks(const std::vector<Track>& tracks) override;
  Result<std::vector<BuiltTile>> take_complete(double along_m) override;

 private:
  struct Segment {
    const SegmentCut* cut;
    LandmarkSelector selector;
    TileAssembler<MappedLandmark> assembler;
  };

  Result<BuiltTile> stored(Segment& segment, std::uint32_t index,
                           const std::vector<MappedLandmark>& landmarks) const;
  LandmarkTile packed(const SegmentCut& segment, std::uint32_t index,
                      const std::vector<MappedLandmark>& landmarks) const;

  const StretchContext& context_;
  LandmarkLayerSettings settings_;
  LandmarkMapper mapper_;
  std::vector<Segment> segments_;
};

}  // namespace milepost
