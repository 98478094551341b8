#include "mapper/pipeline/layers.h"

#include <nlohmann/json.hpp>

namespace milepost {

std::vector<Layer> layers_of(const BuildSettings& settings) {
  std::vector<Layer> layers = {{"tracklets", LayerItems::landmarks, {}, {}, settings.landmarks}};
  if (settings.lab) {
    const double min_r_squared = settings.min_r_squared;
    const RegressionSettings published = {ScaleModel::scale, min_r_squared};
    const RegressionSettings exact = {ScaleModel::inverse_scale, min_r_squared};
    layers.push_back({"tracklets-inverse-scale", LayerItems::tracklets, exact, {}, {}});
    layers.push_back({"tracklets-scale", LayerItems::tracklets, published, {}, {}});
    layers.push_back({"observations", LayerItems::observations, published, {}, {}});
    layers.push_back({"frames", LayerItems::frames, {}, {.features = true}, {}});
    layers.push_back({"wisurf", LayerItems::frames, {}, {.image = true}, {}});
  }
  return layers;
}

std::string parameters_json(const Layer& layer, const Camera& camera, const Codebook& codebook,
                            double tile_length_m) {
  nlohmann::ordered_json parameters = {{"items", name_of(layer.items)}};
  if (layer.items == LayerItems::landmarks) {
    parameters["codebook"] = nlohmann::ordered_json::parse(codebook.to_json());
  } else if (layer.items != LayerItems::frames) {
    parameters["model"] = layer.regression.model == ScaleModel::scale ? "scale" : "inverse-scale";
    parameters["min_r_squared"] = layer.regression.min_r_squared;
  }
  parameters["tile_length_m"] = tile_length_m;
  parameters["focal_px"] = {camera.focal_x_px, camera.focal_y_px};
  return parameters.dump();
}

}  // namespace milepost
