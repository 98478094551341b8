// The layers that a build makes: the default method's and, for the laboratory, those of the others.
#pragma once

#include <string>
#include <vector>

#include "mapper/build/settings.h"
#include "schema/drive/drive.h"

namespace milepost {

enum class LayerItems { tracklets, observations };

struct Layer {
  std::string name;
  LayerItems items = LayerItems::tracklets;
  RegressionSettings regression;  // of tracklets, with or without their observations
};

// `tracklets`, which serves the default method, and with settings.lab: `tracklets-scale`, the
// regression on scale as the paper publishes it, and `observations`, every observation of the same
// tracklets.
std::vector<Layer> layers_of(const BuildSettings& settings);

// The layer's parameters as the map keeps them (FORMAT.md 2.4): a JSON object. The camera's focal
// lengths are among them, since feature scales of another camera compare only after scaling by
// their ratio.
std::string parameters_json(const Layer& layer, const Camera& camera, double tile_length_m);

}  // namespace milepost
