#include "schema/tile/layer_parameters.h"

#include "schema/base/json.h"

namespace milepost {
namespace {

Error corrupt(const std::string& what) {
  return {ErrorCode::corrupt, "", what, "build the map anew"};
}

}  // namespace

std::string to_json(const LayerParameters& parameters) {
  nlohmann::ordered_json json = {{"items", name_of(parameters.items)}};
  if (parameters.codebook) {
    json["codebook"] = nlohmann::ordered_json::parse(parameters.codebook->to_json());
  } else if (parameters.items != LayerItems::frames) {
    json["model"] = parameters.model == ScaleModel::scale ? "scale" : "inverse-scale";
    json["min_r_squared"] = parameters.min_r_squared;
  }
  json["tile_length_m"] = parameters.tile_length_m;
  json["focal_px"] = {parameters.focal_x_px, parameters.focal_y_px};
  return json.dump();
}

Result<LayerParameters> layer_parameters_from_json(const std::string& text) {
  const Result<nlohmann::json> parsed = read_json(text);
  if (!parsed) return corrupt("its parameters: " + parsed.error().what);
  if (!parsed->is_object()) return corrupt("its parameters are no JSON object");
  const nlohmann::json& json = *parsed;
  const auto named = json.value("items", nlohmann::json());
  const auto items = layer_items_named(named.is_string() ? named.get<std::string>() : "");
  if (!items) return corrupt("its items are unknown");
  const auto focal = json.value("focal_px", nlohmann::json());
  const bool two_numbers =
      focal.is_array() && focal.size() == 2 && focal[0].is_number() && focal[1].is_number();
  if (!two_numbers) return corrupt("focal_px is not two numbers");
  LayerParameters parameters;
  parameters.items = *items;
  parameters.focal_x_px = focal[0].get<double>();
  parameters.focal_y_px = focal[1].get<double>();
  const double focal_px = parameters.focal_px();
  if (!(focal_px > 0 && std::isfinite(focal_px))) return corrupt("focal_px is out of range");
  if (*items == LayerItems::landmarks) {
    const Result<Codebook> codebook =
        Codebook::from_json(json.value("codebook", nlohmann::json()).dump());
    if (!codebook) return corrupt("its codebook: " + codebook.error().what);
    parameters.codebook = *codebook;
  }
  return parameters;
}

}  // namespace milepost
