// Matches the features of a query frame with tracklets (the tracklet paper, section 4.2.2).
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "client/evaluate/baselines/tracklet_window.h"
#include "client/localize/estimate.h"
#include "schema/feature/types.h"

namespace milepost {

// The estimate of the capture position from a matched feature: the tracklet's regression at the
// feature's scale (Eq. 3), or the position of the map's frame whose observation has the closest
// scale (the paper's comparative method 3, section 5.2).
enum class Estimation { regression, closest_observation };

struct MatchSettings {
  Estimation estimation = Estimation::regression;
  double max_distance_ratio = 0.8;  // ratio test of descriptor distances
  std::size_t neighbours = 6;       // examined per feature
  // A neighbour that implies the same camera position does not count as the second of the ratio
  // test: one feature on the road may have several tracklets. 0: every neighbour counts, as
  // published.
  double same_place_m = 0;
  double scale_range_margin = 0;  // relative tolerance of the tracklet's scale range
  double pixel_margin = 0.25;     // ... and of its pixel range, in image widths
  double scale_noise = 0.04;      // relative noise of a query feature's scale
  // An estimate farther outside the searched region than this is dropped.
  double region_margin_m = std::numeric_limits<double>::infinity();
};

struct TrackletMatch {
  std::size_t feature = 0;   // of the query
  std::size_t tracklet = 0;  // of the window
  double scale_px = 0;       // of the feature, as the map's camera would see it
  PositionEstimate estimate;
};

// The matches of features with tracklets whose arc length range meets `region`. `scale_ratio`
// converts scales of the query camera to those of the map's camera; `image_width_px` is that of the
// query images. Each tracklet and each feature occurs at most once. REQUIRES: a window of
// observations for Estimation::closest_observation.
std::vector<TrackletMatch> match_tracklets(const FeatureSet& query, double scale_ratio,
                                           int image_width_px, const TrackletWindow& window,
                                           const AlongRange& region, const MatchSettings& settings);

}  // namespace milepost
