// Everything that decides what map is made, beside the drives.
#pragma once

#include "mapper/landmarks/landmark_mapper.h"
#include "mapper/landmarks/selection.h"
#include "mapper/tracklets/feature_follower.h"
#include "schema/feature/types.h"

namespace milepost {

struct LandmarkLayerSettings {
  LandmarkSettings landmarks;
  SelectionSettings selection;
  double size_target_kb_per_m = 0.48;  // no tile weighs more on its stretch of road
};

struct BuildSettings {
  FeatureParameters feature;
  FollowSettings follow;
  double min_r_squared = 0.8;  // section 4.1.1, of tracklets without a landmark
  LandmarkLayerSettings landmarks;
  double codebook_step = 0.02;  // of a compact descriptor
  double tile_length_m = 20;
  double min_frame_spacing_m = 0.3;  // frames nearer to the last one used are passed over
  bool lab = false;                  // layers for the other methods too
  bool allow_empty = false;          // a drive without any tracklet is no error
};

}  // namespace milepost
