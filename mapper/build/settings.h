// Everything that decides the bytes of a map, beside the drives.
#pragma once

#include "mapper/follow/feature_follower.h"
#include "mapper/regress/regression.h"
#include "schema/feature/types.h"

namespace milepost {

struct BuildSettings {
  FeatureParameters feature;
  FollowSettings follow;
  RegressionSettings regression;
  double tile_length_m = 20;
  double min_frame_spacing_m = 0.3;  // frames nearer to the last one used are passed over
  bool lab = false;                  // layers for the other methods too
};

}  // namespace milepost
