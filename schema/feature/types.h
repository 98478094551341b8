// Features of one frame and the parameters that make them, without OpenCV.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "schema/base/result.h"
#include "schema/feature/descriptor.h"

namespace milepost {

// A keypoint in pixels of the camera's pinhole: x to the right, y down, from the centre of the top
// left pixel of its frame.
struct Feature {
  float x_px = 0;
  float y_px = 0;
  float scale_px = 0;       // diameter of the meaningful neighbourhood, > 0
  float magnification = 1;  // pixels of the pinhole per pixel of the frame: its errors grow by it
};

// The features of one frame with one descriptor each.
struct FeatureSet {
  std::vector<Feature> features;
  std::vector<Descriptor> descriptors;  // as many as features

  std::size_t size() const { return features.size(); }
};

// Parameters of the extractor. The map stores them and the client uses them, since descriptors and
// scales are comparable only between extractors with the same parameters.
struct FeatureParameters {
  int max_features = 1000;  // strongest responses kept; 0 keeps all
  int octave_layers = 3;
  double contrast_threshold = 0.04;
  double edge_threshold = 10;
  double sigma = 1.6;

  friend bool operator==(const FeatureParameters&, const FeatureParameters&) = default;
};

// A JSON object with "kind": "sift" and one key per parameter; from_json rejects another kind, an
// unknown or missing key, and values out of range. Errors: corrupt.
nlohmann::ordered_json to_json(const FeatureParameters& parameters);
Result<FeatureParameters> feature_parameters_from_json(const nlohmann::json& json);

}  // namespace milepost
