// Builds the tiles of one segment for the default method: of each as many landmarks as the size
// target allows.
#pragma once

#include <string>
#include <vector>

#include "mapper/landmarks/selection.h"
#include "mapper/pipeline/layer_builder.h"
#include "mapper/pipeline/settings.h"
#include "schema/feature/pca_projection.h"
#include "schema/tile/landmark.h"

namespace milepost {

class LandmarkTileBuilder {
 public:
  // REQUIRES: the line and the projection outlive it.
  LandmarkTileBuilder(std::string segment, const RouteLine& line, const PcaProjection& projection,
                      double tile_length_m, const LandmarkLayerSettings& settings)
      : segment_(std::move(segment)),
        line_(line),
        projection_(projection),
        tile_length_m_(tile_length_m),
        settings_(settings),
        selector_(settings.selection) {}

  // The tile of the landmarks that begin in it; without items if there is nothing to store.
  // REQUIRES: indices ascend. Errors: invalid_input for a tile that holds more than the format
  // allows.
  Result<BuiltTile> build(std::uint32_t index, const std::vector<MappedLandmark>& landmarks);

 private:
  LandmarkTile packed(std::uint32_t index, const std::vector<MappedLandmark>& landmarks) const;

  std::string segment_;
  const RouteLine& line_;
  const PcaProjection& projection_;
  double tile_length_m_;
  LandmarkLayerSettings settings_;
  LandmarkSelector selector_;
};

}  // namespace milepost
