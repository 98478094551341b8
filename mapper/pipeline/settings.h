// All settings that determine the map, in addition to the drives.
#pragma once

#include "mapper/landmarks/landmark_mapper.h"
#include "mapper/landmarks/selection.h"
#include "mapper/tracklets/feature_tracker.h"
#include "schema/feature/types.h"

namespace milepost {

struct LandmarkLayerSettings {
  LandmarkSettings landmarks;
  SelectionSettings selection;
  double size_target_kb_per_m = 0.48;  // upper limit of a tile's size per metre of road
};

struct BuildSettings {
  FeatureParameters feature;
  FeatureTrackingSettings follow;
  double min_r_squared = 0.8;  // section 4.1.1, of the tracklets of --lab layers
  LandmarkLayerSettings landmarks;
  double quantization_step = 0.02;  // quantization step of compact descriptors
  double tile_length_m = 20;
  double min_frame_spacing_m = 0.3;  // frames nearer to the last one used are skipped
  bool lab = false;                  // also build the layers of the other methods
  bool allow_empty = false;          // a drive without any tracklet is not an error
};

}  // namespace milepost
