// A feature scale tracklet, as stored in a map.
// The tracklet paper: section 3.1.1, Eq. 1 (observations) and 4.1.1, Eqs 12 to 15 (stored values).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "schema/base/range.h"
#include "schema/feature/descriptor.h"

namespace milepost {

// The variable f of the regression: along_m = offset + slope * f(scale).
enum class ScaleModel : std::uint8_t {
  scale = 0,  // f(s) = s, the paper's Eq. 2
  inverse_scale =
      1,  // f(s) = -1 / s, exact for a feature of fixed size seen along the optical axis
};

// The regression variable of a feature's scale. REQUIRES: scale_px > 0.
double scale_variable(ScaleModel model, double scale_px);

struct PixelRange {
  float x_min_px = 0;
  float x_max_px = 0;
  float y_min_px = 0;
  float y_max_px = 0;
};

struct Tracklet {
  Descriptor descriptor{};  // mean over the observations, Eq. 15, rounded
  double offset_m = 0;      // regression coefficients, Eq. 2
  double slope = 0;         // > 0; metres per pixel (scale), metre pixels (inverse scale)
  float scale_min_px = 0;   // > 0; SIFT keypoint diameter
  float scale_max_px = 0;
  AlongRange along;                // capture positions of the first and the last observation
  PixelRange pixels;               // of the observations in the frame
  float r_squared = 0;             // Eq. 14, [0, 1]
  float residual_sigma_m = 0;      // sqrt(SS_res / (M - 2)), Eq. 12
  std::uint16_t observations = 0;  // M >= 3

  double along_estimate_m(ScaleModel model, double scale_px) const {
    return offset_m + slope * scale_variable(model, scale_px);  // Eq. 3
  }
};

// The tracklets whose first observation lies in [index, index + 1) * tile length of one segment.
struct TrackletTile {
  std::string segment;
  std::uint32_t index = 0;
  ScaleModel model = ScaleModel::inverse_scale;
  std::vector<Tracklet> tracklets;

  // The smallest range that contains every tracklet's range. REQUIRES: not empty.
  AlongRange along() const;
};

}  // namespace milepost
