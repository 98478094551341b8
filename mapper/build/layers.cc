#include "mapper/build/layers.h"

#include <nlohmann/json.hpp>

namespace milepost {

std::vector<Layer> layers_of(const BuildSettings& settings) {
  std::vector<Layer> layers = {{"tracklets", LayerItems::tracklets, settings.regression}};
  if (settings.lab) {
    const RegressionSettings published = {ScaleModel::scale, settings.regression.min_r_squared};
    layers.push_back({"tracklets-scale", LayerItems::tracklets, published});
    layers.push_back({"observations", LayerItems::observations, published});
  }
  return layers;
}

std::string parameters_json(const Layer& layer, const Camera& camera, double tile_length_m) {
  const nlohmann::ordered_json parameters = {
      {"items", layer.items == LayerItems::tracklets ? "tracklets" : "observations"},
      {"model", layer.regression.model == ScaleModel::scale ? "scale" : "inverse-scale"},
      {"min_r_squared", layer.regression.min_r_squared},
      {"tile_length_m", tile_length_m},
      {"focal_px", {camera.focal_x_px, camera.focal_y_px}}};
  return parameters.dump();
}

}  // namespace milepost
