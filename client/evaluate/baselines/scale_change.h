// How much the scales of matched features differ between two frames: the cost of comparative method
// 2 of the tracklet paper (section 5.2).
#pragma once

#include <cstddef>
#include <optional>

#include "client/evaluate/baselines/frame_window.h"

namespace milepost {

struct ScaleChangeSettings {
  double max_distance_ratio = 0.8;  // nearest neighbour distance ratio, of descriptor distances
  double max_displacement = 0.25;   // of a matched feature, of the image's width
  int min_matches = 5;              // fewer say nothing
};

struct ScaleChange {
  double mean = 0;  // of |ln(scale of the query / scale of the map)|
  int matches = 0;
};

// Each feature of the query is matched to the map's frame on its own. `scale_ratio` brings scales
// of the query's camera to those of the map's camera; `image_width_px` is of the query's images.
// Nothing with too few matches.
std::optional<ScaleChange> scale_change(const FeatureSet& query, double scale_ratio,
                                        int image_width_px, const IndexedFrame& map_frame,
                                        const ScaleChangeSettings& settings);

}  // namespace milepost
