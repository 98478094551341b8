// From a track to a tracklet: the regression from feature scale to arc length.
// The tracklet paper: section 3.1.2, Eq. 2; section 4.1.1, Eqs 12 to 15.
#pragma once

#include <optional>

#include "schema/tile/observation.h"

namespace milepost {

struct RegressionSettings {
  ScaleModel model = ScaleModel::inverse_scale;
  double min_r_squared = 0.8;  // section 4.1.1
};

// The tracklet of a track, or nothing if the track does not determine the position: R^2 below the
// threshold, a scale that does not grow along the road, or no motion.
// REQUIRES: three or more observations.
std::optional<Tracklet> tracklet_from_track(const Track& track, const RegressionSettings& settings);

}  // namespace milepost
