// From a track to a tracklet: the regression from feature scale to along.
// The tracklet paper: section 3.1.2, Eq. 2; section 4.1.1, Eqs 12 to 15.
#pragma once

#include <optional>

#include "schema/tile/observation.h"

namespace milepost {

struct RegressionSettings {
  ScaleModel model = ScaleModel::inverse_scale;
  double min_r_squared = 0.8;  // section 4.1.1
};

// The tracklet of a track, or nothing where the track is no witness of position: R^2 below the
// threshold, a scale that does not grow on the way, or no way at all.
// REQUIRES: three observations or more.
std::optional<Tracklet> tracklet_from_track(const Track& track, const RegressionSettings& settings);

}  // namespace milepost
