// The change of matched features' scales between two frames: the cost of comparative method 2 of
// the tracklet paper (section 5.2).
#pragma once

#include <cstddef>
#include <optional>

#include "client/evaluate/baselines/frame_window.h"

namespace milepost {

struct ScaleChangeSettings {
  double max_distance_ratio = 0.8;  // ratio test of descriptor distances
  double max_displacement = 0.25;   // of a matched feature, in image widths
  int min_matches = 5;              // fewer give no result
};

struct ScaleChange {
  double mean = 0;  // of |ln(scale of the query / scale of the map)|
  int matches = 0;
};

// Each feature of the query is matched with the map's frame independently. `scale_ratio` converts
// scales of the query camera to those of the map's camera; `image_width_px` is that of the query
// images. None with too few matches.
std::optional<ScaleChange> scale_change(const FeatureSet& query, double scale_ratio,
                                        int image_width_px, const IndexedFrame& map_frame,
                                        const ScaleChangeSettings& settings);

}  // namespace milepost
