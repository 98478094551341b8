// All settings that determine the map, in addition to the drives.
#pragma once

#include <optional>

#include "mapper/landmarks/landmark_mapper.h"
#include "mapper/landmarks/selection.h"
#include "mapper/tracklets/feature_tracker.h"
#include "schema/feature/pca_projection.h"
#include "schema/feature/types.h"

namespace milepost {

struct LandmarkLayerSettings {
  LandmarkSettings landmarks;
  SelectionSettings selection;
  double size_target_kb_per_m = 0.48;  // upper limit of a tile's size per metre of road
};

// What becomes of a road that was driven more than once: its segment takes one pass.
enum class PassPolicy {
  keep_best,  // the one in which most is seen
  replace,    // the latest
};

struct BuildSettings {
  FeatureParameters feature;
  FeatureTrackingSettings follow;
  double min_r_squared = 0.8;  // section 4.1.1, of the tracklets of --lab layers
  LandmarkLayerSettings landmarks;
  std::optional<PcaProjection> codebook;  // of compact descriptors; none: the shipped one
  double quantization_step = 0.02;        // of a codebook that is trained
  double tile_length_m = 20;
  double min_frame_spacing_m = 0.3;  // frames nearer to the last one used are skipped
  PassPolicy passes = PassPolicy::keep_best;
  bool lab = false;          // also build the layers of the other methods
  bool allow_empty = false;  // a drive without any tracklet is not an error
};

}  // namespace milepost
