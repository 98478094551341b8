// What a fix would know of its place, from the landmarks that a map has there.
//
// The approximation: one image of a camera on the segment's line, that looks along it, with the
// noise of pixels, scales and landmarks that the client takes (client/localize/pose_solver.h), and
// without what the images before it told. Each landmark that was mapped from there counts with the
// probability that it is found, as when landmarks are selected (mapper/landmarks/selection.h). The
// least sigma and the factor for landmarks that are missed are the client's
// (client/localize/landmark_method.h). Light, traffic and other lanes are not in it.
#pragma once

#include <vector>

#include <Eigen/Core>

namespace milepost {

struct FixSettings {
  double pixel_sigma_px = 1.0;       // of a feature's position, plus ...
  double pixel_per_scale = 0.04;     // ... this part of its scale
  double landmark_sigma_m = 0.02;    // of a landmark's position, per axis
  double scale_sigma = 0.12;         // of the logarithm of a feature's scale, plus ...
  double shared_scale_sigma = 0.05;  // ... a part shared by all of an image
  double min_sigma_m = 0.02;         // of a fix, along and across
  double missed_variance = 6;        // of a fix's variance, for the square of the missed part
  double half_repeated_at = 4;       // observations for a probability of 1/2 to be found again
  // Of the pose before the image.
  double along_sigma_m = 2;
  double lateral_sigma_m = 2.5;
  double up_sigma_m = 0.5;
  double heading_sigma_rad = 0.1;
  double tilt_sigma_rad = 0.04;  // pitch and roll
};

// A landmark as seen from a place: metres ahead, to the right, and up.
struct SightedLandmark {
  Eigen::Vector3d at_m;
  Eigen::Vector3d mapping_ray;  // of length 1, from where it was mapped
  double depth_sigma_m = 0;     // along that ray
  double size_m = 0;
  double size_sigma = 0;  // of ln(size)
  double found = 1;       // probability that an image there has it
};

// The probability that a landmark of so many observations, seen by `passes` of `passes_there`
// drives, is found again.
double probability_of_sight(double observations, double passes, double passes_there,
                            double half_repeated_at);

// Standard deviations against the map, in metres.
struct FixSigma {
  double along_m = 0;
  double lateral_m = 0;

  double worse_m() const { return along_m > lateral_m ? along_m : lateral_m; }
};

// Landmarks behind the camera are ignored; without any the sigmas are those before the image.
// REQUIRES: focal_px > 0.
FixSigma fix_sigma(const std::vector<SightedLandmark>& landmarks, double focal_px,
                   const FixSettings& settings = {});

}  // namespace milepost
