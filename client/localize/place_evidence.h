// What one frame says for a pose and against it: of the landmarks that should be seen from there,
// how many are found in their places and how far off, against what a wrong pose finds by chance.
#pragma once

#include <vector>

#include "client/localize/landmark_matching.h"
#include "client/localize/pose_solver.h"
#include "schema/geo/pinhole.h"

namespace milepost {

// Witnesses, not landmarks: landmarks of one facade are found or missed together (geometric
// burstiness), so those in one cell of the image speak with one voice.
struct PlaceSupport {
  double expected = 0;        // cells of the image in which landmarks should be seen
  double found = 0;           // ... each as the part of its landmarks that are: [0, expected]
  double squared_sigmas = 0;  // how far off those are in squared sigmas of a pixel, summed likewise
  int landmarks_expected = 0;
  int landmarks_found = 0;
};

// Of the landmarks mapped about where the camera is (`along_m`), those that an estimate says are in
// the image, where the frame shows something.
PlaceSupport support_of(const PoseEstimate& estimate, double along_m, const CompactFrame& frame,
                        const std::vector<PlacedLandmark>& landmarks, const PoseSolver& solver,
                        const Camera& given, const LandmarkMatchSettings& settings);

// The logarithm of how much more likely the support is from where the camera is than from
// elsewhere. Both likelihoods are mixtures over what is not known of the frame: the share of
// landmarks found and the spread of their residuals.
double log_bayes_factor(const PlaceSupport& support);

}  // namespace milepost
