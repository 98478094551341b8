// The pose that most matches agree on, where it is not known well enough to search for each
// landmark in its place.
#pragma once

#include <cstdint>
#include <optional>

#include "client/localize/estimate.h"
#include "client/localize/pose_solver.h"
#include "schema/geo/route_line.h"

namespace milepost {

struct ConsensusSettings {
  int samples = 200;            // pairs of matches that propose a pose, at most ...
  double confidence = 0.9999;   // ... and until this certain that one of them is right
  double agreement_sigmas = 3;  // of a match's pixel, to agree with it
  std::uint32_t seed = 1;       // of the draws
};

// Sample consensus over pairs of matches, each completed to a pose by the belief before, then the
// estimate from all matches. Nothing for fewer than two matches. The same input gives the same
// estimate.
std::optional<PoseEstimate> estimate_by_consensus(const PoseSolver& solver,
                                                  const PoseBelief& before,
                                                  const std::vector<LandmarkMatch>& matches,
                                                  const ConsensusSettings& settings);

// What the scale of each match says of along, the camera looking down the line (the tracklet
// paper's Eq. 3 with -1/scale for its variable). `window` is the frame of the landmarks.
std::vector<PositionEstimate> along_by_scale(const std::vector<LandmarkMatch>& matches,
                                             const std::vector<Feature>& features,
                                             const std::vector<PlacedLandmark>& landmarks,
                                             const Pinhole& camera, const RouteLine& line,
                                             const LocalFrame& window, double scale_sigma);

}  // namespace milepost
