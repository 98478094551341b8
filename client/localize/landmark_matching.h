// Which features of a frame are which landmarks.
#pragma once

#include <vector>

#include "client/localize/pose_solver.h"
#include "schema/feature/codebook.h"
#include "schema/feature/feature_grid.h"
#include "schema/geo/pinhole.h"

namespace milepost {

// The features of one frame, ready to be matched.
struct CompactFrame {
  CompactFrame(const FeatureSet& set, const Codebook& codebook);

  const std::vector<Feature>& features;
  std::vector<CompactDescriptor> descriptors;
  FeatureGrid grid;
};

struct LandmarkMatchSettings {
  double max_distance = 0.75;  // of RootSIFT, which has length 1, between feature and landmark
  double max_distance_ratio = 0.85;  // to the second nearest at another place, in the whole frame
  double max_expected_ratio = 0.9;   // ... in the area where the landmark is expected
  double same_place_m = 1;           // landmarks so near to each other are one place
  double along_margin_m = 4;         // beyond the along range where a landmark was mapped
  double max_log_scale = 0.5;        // of a feature's scale against what is expected
  double gate_sigmas = 3;            // of the expected pixel ...
  double min_gate_px = 6;
  double max_gate_px = 80;
};

// For each feature its nearest landmark among those mapped in `region`, by descriptors alone.
std::vector<LandmarkMatch> match_anywhere(const CompactFrame& frame, double codebook_step,
                                          const std::vector<PlacedLandmark>& landmarks,
                                          const AlongRange& region,
                                          const LandmarkMatchSettings& settings);

// For each landmark mapped in `region` the feature that is the most alike where the landmark is
// expected from a belief.
std::vector<LandmarkMatch> match_expected(const CompactFrame& frame, double codebook_step,
                                          const std::vector<PlacedLandmark>& landmarks,
                                          const AlongRange& region, const PoseBelief& belief,
                                          const Pinhole& camera,
                                          const LandmarkMatchSettings& settings);

}  // namespace milepost
