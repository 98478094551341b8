#include "schema/tile/layer_parameters.h"

#include <nlohmann/json.hpp>

namespace milepost {
namespace {

constexpr const char* kPinhole = "pinhole";
constexpr double kMaxFocalPx = 1e6;

bool is_focal_length(double focal_px) { return focal_px > 0 && focal_px <= kMaxFocalPx; }

Error corrupt(const std::string& what) { return {ErrorCode::corrupt, "", what, "rebuild the map"}; }

}  // namespace

nlohmann::ordered_json to_json(const LayerParameters& parameters) {
  nlohmann::ordered_json json = {{"items", name_of(parameters.items)}};
  if (parameters.projection) {
    json["codebook"] = parameters.projection->to_json();
  } else if (parameters.items != LayerItems::frames) {
    json["model"] = parameters.model == ScaleModel::scale ? "scale" : "inverse-scale";
    json["min_r_squared"] = parameters.min_r_squared;
  }
  json["tile_length_m"] = parameters.tile_length_m;
  json["camera_model"] = kPinhole;  // the only one
  json["focal_px"] = {parameters.focal_x_px, parameters.focal_y_px};
  return json;
}

nlohmann::ordered_json to_json(const WallLayerParameters& parameters) {
  nlohmann::ordered_json json = {{"items", kWallItems}};
  if (!parameters.footprints.empty()) json["footprints"] = parameters.footprints;
  if (const auto& from = parameters.extracted) {
    json["image"] = from->image;
    json["bands"] = from->bands;
    if (from->alpha_band != 0) json["alpha_band"] = from->alpha_band;
    json["bounds"] = {{"west_deg", from->bounds.west_deg},
                      {"south_deg", from->bounds.south_deg},
                      {"east_deg", from->bounds.east_deg},
                      {"north_deg", from->bounds.north_deg}};
    json["metres_per_pixel"] = from->metres_per_pixel;
    json["min_length_m"] = from->min_length_m;
    json["min_roof_difference"] = from->min_roof_difference;
    json["without"] = from->without;
    json["sun"] = {{"azimuth_deg", from->sun_azimuth_deg},
                   {"elevation_deg", from->sun_elevation_deg},
                   {"estimated", from->sun_was_estimated}};
  }
  return json;
}

std::string items_named_in(const nlohmann::json& parameters) {
  if (!parameters.is_object()) return "";
  const auto items = parameters.find("items");
  return items != parameters.end() && items->is_string() ? items->get<std::string>() : "";
}

Result<LayerParameters> layer_parameters_from_json(const nlohmann::json& json) {
  if (!json.is_object()) return corrupt("its parameters are not a JSON object");
  const auto items = layer_items_named(items_named_in(json));
  if (!items) return corrupt("its items are unknown");
  const auto focal = json.value("focal_px", nlohmann::json());
  const bool two_numbers =
      focal.is_array() && focal.size() == 2 && focal[0].is_number() && focal[1].is_number();
  if (!two_numbers) return corrupt("focal_px is not two numbers");
  LayerParameters parameters;
  parameters.items = *items;
  parameters.focal_x_px = focal[0].get<double>();
  parameters.focal_y_px = focal[1].get<double>();
  if (!is_focal_length(parameters.focal_x_px) || !is_focal_length(parameters.focal_y_px)) {
    return corrupt("focal_px is out of range");
  }
  if (json.value("camera_model", nlohmann::json(kPinhole)) != kPinhole) {
    return corrupt("its camera_model is unknown");
  }
  if (*items == LayerItems::landmarks) {
    const Result<PcaProjection> projection =
        PcaProjection::from_json(json.value("codebook", nlohmann::json()));
    if (!projection) return corrupt("its codebook: " + projection.error().what);
    parameters.projection = *projection;
  }
  return parameters;
}

}  // namespace milepost
