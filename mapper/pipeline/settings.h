// All settings that determine the map, in addition to the drives.
#pragma once

#include <filesystem>
#include <optional>

#include "mapper/fusion/merging.h"
#include "mapper/fusion/slow_errors.h"
#include "mapper/fusion/tie.h"
#include "mapper/landmarks/landmark_mapper.h"
#include "mapper/landmarks/selection.h"
#include "mapper/network/border.h"
#include "mapper/tracklets/feature_tracker.h"
#include "schema/feature/pca_projection.h"
#include "schema/feature/types.h"

namespace milepost {

struct LandmarkLayerSettings {
  LandmarkSettings landmarks;
  SelectionSettings selection;
  double size_target_kb_per_m = 0.48;  // upper limit of a tile's size per metre of road
};

// What becomes of a road that was driven more than once: whose landmarks its segment takes.
enum class PassPolicy {
  fuse,       // those of all passes; its line is that of the one in which most is seen
  keep_best,  // the pass in which most is seen
  replace,    // the latest
};

// How drives that passed one road become one map of it.
struct FusionSettings {
  TieSettings tie;
  SlowErrorSettings errors;
  MergeSettings merge;
};

// Divides the network: segments right of the border are written to a map of their own, and segments
// of either map may go on in the other.
struct Division {
  Border border;
  std::filesystem::path beyond;  // the map file of what is right of it
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
  PassPolicy passes = PassPolicy::fuse;
  FusionSettings fusion;
  std::optional<Division> division;
  bool lab = false;                // also build the layers of the other methods
  double min_fitting_share = 0.3;  // of a drive's tracks, to its poses; otherwise the build fails
  bool allow_empty = false;        // a drive without any tracklet is not an error
};

}  // namespace milepost
