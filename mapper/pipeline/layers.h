// The layers that a build makes: the default method's and, for the laboratory, those of the others.
#pragma once

#include <string>
#include <vector>

#include "mapper/pipeline/settings.h"
#include "mapper/tracklets/regression.h"
#include "schema/drive/drive.h"
#include "schema/feature/codebook.h"
#include "schema/tile/layer_items.h"

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

// The layer's parameters as the map keeps them (FORMAT.md 2.4): a JSON object. The camera's focal
// lengths are among them, since feature scales of another camera compare only after scaling by
// their ratio; and of landmarks the codebook.
std::string parameters_json(const Layer& layer, const Camera& camera, const Codebook& codebook,
                            double tile_length_m);

}  // namespace milepost
