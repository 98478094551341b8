#include "mapper/build/layers.h"

#include <nlohmann/json.hpp>

namespace milepost {

std::vector<TrackletLayer> tracklet_layers(const BuildSettings& settings) {
  std::vector<TrackletLayer> layers = {{"tracklets", settings.regression}};
  if (settings.lab) {
    layers.push_back({"tracklets-scale", {ScaleModel::scale, settings.regression.min_r_squared}});
  }
  return layers;
}

std::string parameters_json(const TrackletLayer& layer, const Camera& camera,
                            double tile_length_m) {
  const nlohmann::ordered_json parameters = {
      {"items", "tracklets"},
      {"model", layer.regression.model == ScaleModel::scale ? "scale" : "inverse-scale"},
      {"min_r_squared", layer.regression.min_r_squared},
      {"tile_length_m", tile_length_m},
      {"focal_px", {camera.focal_x_px, camera.focal_y_px}}};
  return parameters.dump();
}

}  // namespace milepost
