// The layers that a build makes: the default method's and, for the laboratory, those of the others.
#pragma once

#include <string>
#include <vector>

#include "mapper/pipeline/settings.h"
#include "mapper/tracklets/regression.h"
#include "schema/drive/drive.h"
#include "schema/feature/codebook.h"
#include "schema/tile/layer_parameters.h"

namespace milepost {

struct FrameParts {
  bool features = false;  // all of each frame
  bool image = false;     // the descriptor of the whole image
};

struct Layer {
  std::string name;
  LayerItems items = LayerItems::tracklets;
  RegressionSettings regression;  // of tracklets, with or without their observations
  FrameParts parts;               // of frames
  LandmarkLayerSettings landmarks;
};

// `tracklets`, which serves the default method by landmarks, and with settings.lab:
// `tracklets-inverse-scale`, the regression on -1/scale; `tracklets-scale`, on scale as the paper
// publishes it; `observations`, every observation of the same tracklets; `frames`, all features of
// each frame; `wisurf`, a descriptor of each whole frame.
std::vector<Layer> layers_of(const BuildSettings& settings);

// What the map says of the layer.
LayerParameters parameters_of(const Layer& layer, const Camera& camera, const Codebook& codebook,
                              double tile_length_m);

}  // namespace milepost
