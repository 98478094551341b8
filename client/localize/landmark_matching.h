// Matching of a frame's features with landmarks.
#pragma once

#include <vector>

#include "client/localize/pose_solver.h"
#include "schema/feature/feature_grid.h"
#include "schema/feature/pca_projection.h"
#include "schema/geo/pinhole.h"

namespace milepost {

// The features of one frame, prepared for matching.
struct CompactFrame {
  CompactFrame(const FeatureSet& set, const PcaProjection& projection);

  const std::vector<Feature>& features;
  std::vector<CompactDescriptor> descriptors;
  FeatureGrid grid;
};

struct LandmarkMatchSettings {
  double max_distance = 0.75;        // of descriptors (RootSIFT, length 1) that match
  double max_distance_ratio = 0.85;  // ratio test with the nearest at another place, global ...
  double max_guided_ratio = 0.9;     // ... and guided matching
  double same_place_m = 1;           // landmarks closer than this are at one place
  double along_margin_m = 4;         // beyond the arc length range in which a landmark was mapped
  double max_log_scale = 0.5;        // of a feature's scale over the predicted one
  double gate_sigmas = 3;            // radius of the search gate, in sigmas ...
  double min_gate_px = 6;            // ... within these bounds
  double max_gate_px = 80;
};

// Global matching: for each feature the nearest landmark mapped in `region`, by descriptors alone.
std::vector<LandmarkMatch> match_global(const CompactFrame& frame, double quantization_step,
                                        const std::vector<LocalLandmark>& landmarks,
                                        const AlongRange& region,
                                        const LandmarkMatchSettings& settings);

// Guided matching: for each landmark mapped in `region` the feature with the nearest descriptor in
// the search gate predicted from a belief.
std::vector<LandmarkMatch> match_guided(const CompactFrame& frame, double quantization_step,
                                        const std::vector<LocalLandmark>& landmarks,
                                        const AlongRange& region, const PoseBelief& belief,
                                        const Pinhole& camera,
                                        const LandmarkMatchSettings& settings);

}  // namespace milepost
