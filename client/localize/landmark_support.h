// The log Bayes factor of one frame for a pose: how many of the landmarks predicted from there are
// found and with which residuals, compared with what a wrong pose finds by chance.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "client/localize/landmark_matching.h"
#include "client/localize/pose_solver.h"
#include "schema/geo/camera.h"

namespace milepost {

// Counts image cells instead of landmarks: landmarks of one facade are found or missed together
// (geometric burstiness), so those in one image cell count as one observation.
struct LandmarkSupport {
  static constexpr std::size_t kResidualBins = 16;  // up to the cutoff of inliers

  double expected = 0;  // image cells in which landmarks are predicted
  double found = 0;     // ... sum of the found parts of their landmarks: [0, expected]
  std::array<double, kResidualBins> by_residual{};  // of those, by their pixel residual in sigmas
  int landmarks_expected = 0;
  int landmarks_found = 0;
};

// The support of an estimate: of the landmarks mapped around the arc length `along_m`, those that
// it projects into textured parts of the image.
LandmarkSupport support_of(const PoseEstimate& estimate, double along_m, const CompactFrame& frame,
                           const std::vector<LocalLandmark>& landmarks, const PoseSolver& solver,
                           const Camera& given, const LandmarkMatchSettings& settings);

// The log Bayes factor of a support for "the camera is here" against "elsewhere". Both likelihoods
// are mixtures over what is unknown of the frame: the detection rate, the residuals' variance, and
// the share of matches that are wrong.
double log_bayes_factor(const LandmarkSupport& support);

}  // namespace milepost
