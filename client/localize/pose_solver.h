// The camera's pose from landmarks seen in one frame, and from what was believed before.
//
// Maximum a posteriori: the belief before the frame, the bearings of the landmarks, and their
// scales (the tracklet paper's Eq. 3 in another form: the scale of a feature of known size says its
// depth, and depth says along) in one robust least squares problem. With many landmarks bearings
// decide; with few, scales and the belief.
#pragma once

#include <cstddef>
#include <vector>

#include "client/localize/landmark_window.h"
#include "client/localize/pose_belief.h"
#include "schema/feature/types.h"
#include "schema/geo/pinhole.h"

namespace milepost {

// A feature of the frame that is taken for a landmark.
struct LandmarkMatch {
  std::size_t feature = 0;   // of the frame
  std::size_t landmark = 0;  // of the window
};

struct PoseSolverSettings {
  double pixel_sigma_px = 1.0;       // of a feature, beside ...
  double pixel_per_scale = 0.04;     // ... this part of its scale
  double landmark_sigma_m = 0.02;    // of a landmark's position, in each direction
  double scale_sigma = 0.12;         // of the logarithm of a feature's scale ...
  double shared_scale_sigma = 0.05;  // ... beside what all of a frame share: blur makes all larger
  double cauchy = 2;                 // a match so many sigmas off weighs half at first ...
  double cutoff = 4;                 // ... and beyond so many, at last, nothing (Tukey's biweight)
  int iterations = 6;                // at first, and at last
};

struct PoseEstimate {
  PoseBelief belief;                    // with this frame
  std::vector<LandmarkMatch> agreeing;  // matches within the cutoff
};

class PoseSolver {
 public:
  // REQUIRES: what is referred to outlives the solver.
  PoseSolver(const Pinhole& camera, const std::vector<Feature>& features,
             const std::vector<PlacedLandmark>& landmarks, const PoseSolverSettings& settings)
      : camera_(camera), features_(features), landmarks_(landmarks), settings_(settings) {}

  // The estimate from `matches`, found from `initial` on.
  PoseEstimate estimate(const PoseBelief& before, const StateVector& initial,
                        const std::vector<LandmarkMatch>& matches) const;
  // The state that fits `before` and few matches, all of which are trusted. `before_information` is
  // the inverse of its covariance.
  StateVector hypothesis(const PoseBelief& before, const StateMatrix& before_information,
                         const std::vector<LandmarkMatch>& matches) const;
  // How many sigmas each match's pixel is off, seen in a state; infinite behind the camera.
  std::vector<double> pixel_sigmas(const StateVector& state,
                                   const std::vector<LandmarkMatch>& matches) const;

 private:
  struct View;
  struct Seen;
  struct Linearized;

  bool look(const View& view, const LandmarkMatch& match, Seen& at) const;
  void linearize(const View& view, const LandmarkMatch& match, const Seen& seen,
                 Linearized& at) const;
  template <class Weight>
  bool step(const PoseBelief& before, const StateMatrix& before_information,
            const std::vector<LandmarkMatch>& matches, const Weight& weight, StateVector& state,
            StateMatrix& information) const;

  Pinhole camera_;
  const std::vector<Feature>& features_;
  const std::vector<PlacedLandmark>& landmarks_;
  PoseSolverSettings settings_;
};

}  // namespace milepost
