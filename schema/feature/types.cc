#include "schema/feature/types.h"

#include <cmath>

#include <nlohmann/json.hpp>

namespace milepost {
namespace {

Error corrupt_parameters(const std::string& what) {
  return {ErrorCode::corrupt, "feature parameters", what, "rebuild the map"};
}

// Extracts a number within [low, high] from `object`.
template <class Number>
Status take(nlohmann::json& object, const char* key, double low, double high, Number& value) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_number()) {
    return corrupt_parameters(std::string("'") + key + "' is missing or not a number");
  }
  const double number = found->template get<double>();
  if (!(number >= low && number <= high)) {
    return corrupt_parameters(std::string("'") + key + "' is out of range");
  }
  value = static_cast<Number>(number);
  object.erase(found);
  return ok_status();
}

}  // namespace

nlohmann::ordered_json to_json(const FeatureParameters& parameters) {
  return {{"kind", "sift"},
          {"max_features", parameters.max_features},
          {"octave_layers", parameters.octave_layers},
          {"contrast_threshold", parameters.contrast_threshold},
          {"edge_threshold", parameters.edge_threshold},
          {"sigma", parameters.sigma}};
}

Result<FeatureParameters> feature_parameters_from_json(const nlohmann::json& json) {
  nlohmann::json object = json;  // known keys are erased; those left are unknown
  if (!object.is_object()) return corrupt_parameters("they are not a JSON object");
  if (!object.contains("kind") || object["kind"] != "sift") {
    return corrupt_parameters("their kind is not 'sift'");
  }
  object.erase("kind");
  FeatureParameters parameters;
  for (const Status& status :
       {take(object, "max_features", 0, 1e6, parameters.max_features),
        take(object, "octave_layers", 1, 16, parameters.octave_layers),
        take(object, "contrast_threshold", 0, 1, parameters.contrast_threshold),
        take(object, "edge_threshold", 0, 1e6, parameters.edge_threshold),
        take(object, "sigma", 0.1, 16, parameters.sigma)}) {
    if (!status.ok()) return status.error();
  }
  if (!object.empty()) return corrupt_parameters("'" + object.begin().key() + "' is unknown");
  return parameters;
}

double image_distance(const ImageDescriptor& a, const ImageDescriptor& b) {
  double square = 0;
  for (std::size_t k = 0; k < a.size(); ++k) square += (a[k] - b[k]) * (a[k] - b[k]);
  return std::sqrt(square);
}

}  // namespace milepost
