// Sample consensus (RANSAC) of a pose, for when it is not known well enough for guided matching.
#pragma once

#include <cstdint>
#include <optional>

#include "client/localize/estimate.h"
#include "client/localize/pose_solver.h"
#include "schema/geo/route_line.h"

namespace milepost {

struct ConsensusSettings {
  int samples = 200;            // maximum number of pairs of matches drawn ...
  double confidence = 0.9999;   // ... until one is free of outliers with this confidence
  double agreement_sigmas = 3;  // pixel residual of an inlier
  std::uint32_t seed = 1;       // of the draws
};

// Sample consensus over pairs of matches, each completed to a pose by the prior belief `before`,
// then the estimate from all matches. None for fewer than two matches. The same input gives the
// same estimate.
std::optional<PoseEstimate> estimate_by_consensus(const PoseSolver& solver,
                                                  const PoseBelief& before,
                                                  const std::vector<LandmarkMatch>& matches,
                                                  const ConsensusSettings& settings);

// The arc length estimated from the scale of each match, for a camera that looks along the line
// (the tracklet paper's Eq. 3 with the variable -1/scale).
std::vector<PositionEstimate> along_by_scale(const std::vector<LandmarkMatch>& matches,
                                             const std::vector<Feature>& features,
                                             const std::vector<LocalLandmark>& landmarks,
                                             const Pinhole& camera, double scale_sigma);

}  // namespace milepost
