// The layers of tracklets that a build makes: the default method's and, for the laboratory, others.
#pragma once

#include <string>
#include <vector>

#include "mapper/build/settings.h"
#include "schema/drive/drive.h"

namespace milepost {

struct TrackletLayer {
  std::string name;
  RegressionSettings regression;
};

// `tracklets`, which serves the default method, and with settings.lab `tracklets-scale`, the
// regression on scale as the paper publishes it.
std::vector<TrackletLayer> tracklet_layers(const BuildSettings& settings);

// The layer's parameters as the map keeps them: a JSON object. The camera's focal lengths are among
// them, since feature scales of another camera compare only after scaling by their ratio.
std::string parameters_json(const TrackletLayer& layer, const Camera& camera, double tile_length_m);

}  // namespace milepost
