#include "mapper/pipeline/layers.h"

namespace milepost {
namespace {

constexpr double kReferenceFocalPx = 1000;

}  // namespace

std::vector<Layer> layers_of(const BuildSettings& settings) {
  std::vector<Layer> made = {
      {layers::kLandmarks, LayerItems::landmarks, {}, {}, settings.landmarks}};
  if (settings.lab) {
    const double min_r_squared = settings.min_r_squared;
    const RegressionSettings published = {ScaleModel::scale, min_r_squared};
    const RegressionSettings exact = {ScaleModel::inverse_scale, min_r_squared};
    made.push_back({layers::kTrackletsByInverseScale, LayerItems::tracklets, exact, {}, {}});
    made.push_back({layers::kTrackletsByScale, LayerItems::tracklets, published, {}, {}});
    made.push_back({layers::kObservations, LayerItems::observations, published, {}, {}});
    made.push_back({layers::kFrames, LayerItems::frames, {}, {.features = true}, {}});
    made.push_back({layers::kWholeImages, LayerItems::frames, {}, {.image = true}, {}});
  }
  return made;
}

LayerParameters parameters_of(const Layer& layer, const Camera& camera,
                              const PcaProjection& codebook, double tile_length_m) {
  LayerParameters parameters;
  parameters.items = layer.items;
  parameters.tile_length_m = tile_length_m;
  parameters.focal_x_px = camera.pinhole.focal_x_px;
  parameters.focal_y_px = camera.pinhole.focal_y_px;
  if (layer.items == LayerItems::landmarks) {  // whose tiles hold nothing in pixels
    parameters.focal_x_px = parameters.focal_y_px = kReferenceFocalPx;
    parameters.projection = codebook;
  }
  parameters.model = layer.regression.model;
  parameters.min_r_squared = layer.regression.min_r_squared;
  return parameters;
}

}  // namespace milepost
