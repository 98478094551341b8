// Maximum a posteriori estimation of the camera's pose from landmarks in one frame.
//
// One robust least squares problem combines the prior belief, the bearings of the landmarks and
// their scales (the tracklet paper's Eq. 3 in another form: the scale of a feature of known size
// determines its depth, and depth determines arc length). With many landmarks the bearings
// dominate; with few, the scales and the prior.
#pragma once

#include <cstddef>
#include <vector>

#include "client/localize/landmark_window.h"
#include "client/localize/pose_belief.h"
#include "schema/feature/types.h"
#include "schema/geo/pinhole.h"

namespace milepost {

// A match of a feature with a landmark.
struct LandmarkMatch {
  std::size_t feature = 0;   // of the frame
  std::size_t landmark = 0;  // of the window
};

struct PoseSolverSettings {
  double pixel_sigma_px = 1.0;       // of a feature's position, plus ...
  double pixel_per_scale = 0.04;     // ... this part of its scale
  double landmark_sigma_m = 0.02;    // of a landmark's position, per axis
  double scale_sigma = 0.12;         // of the logarithm of a feature's scale, plus ...
  double shared_scale_sigma = 0.05;  // ... a part shared by all of a frame: blur enlarges all
  double cauchy = 2;                 // Cauchy weight at first: 1/2 at this many sigmas ...
  // ... then Tukey's biweight: 0 from this many robust standard deviations of the residuals on, and
  // from no fewer sigmas than `min_biweight_cutoff`. Sigmas are wide enough for wrong matches to
  // lie within them.
  double biweight_deviations = 2.5;
  double min_biweight_cutoff = 1.5;
  double cutoff = 4;   // of inliers, in sigmas
  int iterations = 6;  // with each of the two weights
};

struct PoseEstimate {
  PoseBelief belief;                    // posterior, with this frame
  std::vector<LandmarkMatch> agreeing;  // inliers: matches within the cutoff
};

class PoseSolver {
 public:
  // REQUIRES: all references outlive the solver.
  PoseSolver(const Pinhole& camera, const std::vector<Feature>& features,
             const std::vector<LocalLandmark>& landmarks, const PoseSolverSettings& settings)
      : camera_(camera), features_(features), landmarks_(landmarks), settings_(settings) {}

  // The estimate from `matches`, starting the iteration at `initial`.
  PoseEstimate estimate(const PoseBelief& before, const StateVector& initial,
                        const std::vector<LandmarkMatch>& matches) const;
  // The state that fits the prior `before` and a few matches, all of which are trusted.
  // `before_information` is the inverse of its covariance.
  StateVector hypothesis(const PoseBelief& before, const StateMatrix& before_information,
                         const std::vector<LandmarkMatch>& matches) const;
  // The Mahalanobis distance of each match's pixel residual at a state; infinite behind the camera.
  std::vector<double> pixel_sigmas(const StateVector& state,
                                   const std::vector<LandmarkMatch>& matches) const;

 private:
  struct View;
  struct Seen;
  struct Linearized;

  bool look(const View& view, const LandmarkMatch& match, Seen& at) const;
  void linearize(const View& view, const LandmarkMatch& match, const Seen& seen,
                 Linearized& at) const;
  double biweight_cutoff(const StateVector& state, const std::vector<LandmarkMatch>& matches) const;
  template <class Weight>
  bool step(const PoseBelief& before, const StateMatrix& before_information,
            const std::vector<LandmarkMatch>& matches, const Weight& weight, StateVector& state,
            StateMatrix& information) const;

  Pinhole camera_;
  const std::vector<Feature>& features_;
  const std::vector<LocalLandmark>& landmarks_;
  PoseSolverSettings settings_;
};

}  // namespace milepost
