// Matches the features of a query frame to tracklets (the tracklet paper, section 4.2.2).
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "client/evaluate/baselines/tracklet_window.h"
#include "client/localize/estimate.h"
#include "schema/feature/types.h"

namespace milepost {

// What a matched feature says of the capture position: the tracklet's regression at the feature's
// scale (Eq. 3), or where the map's frame was whose observation's scale is the closest (the paper's
// comparative method 3, section 5.2).
enum class Estimation { regression, closest_observation };

struct MatchSettings {
  Estimation estimation = Estimation::regression;
  double max_distance_ratio = 0.8;  // nearest neighbour distance ratio, of descriptor distances
  std::size_t neighbours = 6;       // looked at for each feature
  // A neighbour that would put the camera at the same place does not count against the nearest one:
  // one feature of the road may have several tracklets. 0: every neighbour counts, as published.
  double same_place_m = 0;
  double scale_range_margin = 0;  // the query's scale may leave the tracklet's range by this part
  double pixel_margin = 0.25;     // ... and its pixels by this part of the image's width
  double scale_noise = 0.04;      // relative noise of a query feature's scale
  // An estimate farther outside the region searched contradicts that region and is dropped.
  double region_margin_m = std::numeric_limits<double>::infinity();
};

struct TrackletMatch {
  std::size_t feature = 0;   // of the query
  std::size_t tracklet = 0;  // of the window
  double scale_px = 0;       // of the feature, as the map's camera would see it
  PositionEstimate estimate;
};

// The matches of features to tracklets whose along range meets `region`. `scale_ratio` brings
// scales of the query's camera to those of the map's camera; `image_width_px` is of the query's
// images. Each tracklet and each feature occurs once at most.
// REQUIRES: a window of observations for Estimation::closest_observation.
std::vector<TrackletMatch> match_tracklets(const FeatureSet& query, double scale_ratio,
                                           int image_width_px, const TrackletWindow& window,
                                           const AlongRange& region, const MatchSettings& settings);

}  // namespace milepost
