// The layers of a map by name, and what the map says of each (FORMAT.md 2.4): the one place that
// reads and writes it.
#pragma once

#include <cmath>
#include <optional>
#include <string>

#include "schema/base/result.h"
#include "schema/feature/codebook.h"
#include "schema/tile/layer_items.h"
#include "schema/tile/tracklet.h"

namespace milepost {

namespace layers {

inline constexpr const char* kLandmarks = "tracklets";  // of the default method
inline constexpr const char* kWalls = "walls";
// Of the laboratory:
inline constexpr const char* kTrackletsByInverseScale = "tracklets-inverse-scale";
inline constexpr const char* kTrackletsByScale = "tracklets-scale";
inline constexpr const char* kObservations = "observations";
inline constexpr const char* kFrames = "frames";
inline constexpr const char* kWholeImages = "wisurf";

}  // namespace layers

// Of a layer whose tiles lie along segments.
struct LayerParameters {
  LayerItems items = LayerItems::tracklets;
  double tile_length_m = 0;
  // Of the map's camera: feature scales of another compare only after scaling by their ratio.
  double focal_x_px = 0;
  double focal_y_px = 0;
  std::optional<Codebook> codebook = {};         // of landmarks
  ScaleModel model = ScaleModel::inverse_scale;  // of tracklets, with or without their observations
  double min_r_squared = 0;                      // ... likewise

  double focal_px() const { return std::sqrt(focal_x_px * focal_y_px); }
};

// A JSON object.
std::string to_json(const LayerParameters& parameters);

// What a client needs of it: items, focal lengths, and of landmarks the codebook; keys that it does
// not know are left alone. Errors: corrupt, without a place.
Result<LayerParameters> layer_parameters_from_json(const std::string& text);

}  // namespace milepost
