// The layers of a build: that of the default method and, with --lab, those of the other methods.
#pragma once

#include <string>
#include <vector>

#include "mapper/pipeline/settings.h"
#include "mapper/tracklets/regression.h"
#include "schema/drive/drive.h"
#include "schema/feature/pca_projection.h"
#include "schema/tile/layer_parameters.h"

namespace milepost {

struct FrameParts {
  bool features = false;  // all features of each frame
  bool image = false;     // the descriptor of the whole image
};

struct Layer {
  std::string name;
  LayerItems items = LayerItems::tracklets;
  RegressionSettings regression;  // of tracklets, with or without their observations
  FrameParts parts;               // of frames
  LandmarkLayerSettings landmarks;
};

// `tracklets`, the landmarks of the default method, and with settings.lab:
// `tracklets-inverse-scale`, the regression on -1/scale; `tracklets-scale`, on scale as in the
// paper; `observations`, every observation of the same tracklets; `frames`, all features of each
// frame; `wisurf`, a whole-image descriptor of each frame.
std::vector<Layer> layers_of(const BuildSettings& settings);

// The parameters of the layer that the map stores. `camera` is the drives'.
LayerParameters parameters_of(const Layer& layer, const Camera& camera,
                              const PcaProjection& codebook, double tile_length_m);

}  // namespace milepost
