// The names of a map's layers, and the reading and writing of their parameters (FORMAT.md 2.4).
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "schema/base/cell_grid.h"
#include "schema/base/result.h"
#include "schema/feature/pca_projection.h"
#include "schema/tile/layer_items.h"
#include "schema/tile/tracklet.h"

namespace milepost {

namespace layers {

inline constexpr const char* kLandmarks = "tracklets";  // of the default method
inline constexpr const char* kWalls = "walls";
// Added by `build --lab`:
inline constexpr const char* kTrackletsByInverseScale = "tracklets-inverse-scale";
inline constexpr const char* kTrackletsByScale = "tracklets-scale";
inline constexpr const char* kObservations = "observations";
inline constexpr const char* kFrames = "frames";
inline constexpr const char* kWholeImages = "wisurf";

}  // namespace layers

// How directions are imaged.
enum class CameraModel { pinhole };

// Parameters of a layer whose tiles lie along segments.
struct LayerParameters {
  LayerItems items = LayerItems::tracklets;
  double tile_length_m = 0;
  // The reference camera. Scales and pixels of a drive's own camera, of the mapper's as of the
  // vehicle's, are converted to it by the ratio of focal lengths before they are compared.
  CameraModel camera_model = CameraModel::pinhole;
  double focal_x_px = 0;
  double focal_y_px = 0;
  std::optional<PcaProjection> projection = {};  // of landmarks
  ScaleModel model = ScaleModel::inverse_scale;  // of tracklets, with or without their observations
  double min_r_squared = 0;                      // ... likewise

  double focal_px() const { return std::sqrt(focal_x_px * focal_y_px); }
};

nlohmann::ordered_json to_json(const LayerParameters& parameters);

// The parameters that a client needs: items, the reference camera (a pinhole camera where the model
// is missing), and the codebook of landmarks; unknown keys are ignored. Errors: corrupt, with
// `where` empty.
Result<LayerParameters> layer_parameters_from_json(const nlohmann::json& json);

// The source of a layer of walls, whose tiles are grid cells. Informative: a client needs none of
// it.
struct WallLayerParameters {
  struct Orthoimage {
    std::string image;            // the file's name
    std::vector<int> bands = {};  // used, counted from 1
    int alpha_band = 0;           // 0: none
    Bounds bounds = {};
    double metres_per_pixel = 0;
    double min_length_m = 0;
    double min_roof_difference = 0;
    std::vector<std::string> without = {};  // stages left out
    double sun_azimuth_deg = 0;
    double sun_elevation_deg = 0;
    bool sun_was_estimated = false;
  };
  std::string footprints = {};  // the file's name; empty: none
  std::optional<Orthoimage> extracted = {};
};

nlohmann::ordered_json to_json(const WallLayerParameters& parameters);

// The items that a layer's parameters name; empty if they name none.
std::string items_named_in(const nlohmann::json& parameters);
inline constexpr const char* kWallItems = "walls";

}  // namespace milepost
