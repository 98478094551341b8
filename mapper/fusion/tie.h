// How far the poses of two drives differ in one place.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "mapper/fusion/pass_landmark.h"
#include "mapper/fusion/pose_error.h"

namespace milepost {

// A place of a stretch.
struct StretchPlace {
  std::size_t stretch = 0;
  double along_m = 0;
};

// The errors of `b` minus those of `a`.
struct Tie {
  StretchPlace a, b;
  ErrorVector difference = ErrorVector::Zero();
  ErrorMatrix covariance = ErrorMatrix::Zero();
};

struct TieSettings {
  double max_offset_m = 4;         // between the positions of two drives
  double max_sigma_m = 3;          // of a landmark along its first ray, to be used
  double min_sigma_m = 0.03;       // of two positions of one landmark, seen from different lanes
  double tie_sigma_m = 0.02;       // of what all matches of a place have in common
  double roll_sigma_rad = 0.05;    // of what two drives may differ in roll, ...
  double turn_sigma_rad = 0.0003;  // ... and in yaw and pitch, of which nothing is kept
  double cutoff_sigmas = 3;        // of inliers
  std::size_t min_inliers = 10;
  double min_inlier_ratio = 0.3;
};

// The tie of two drives from the landmarks of each that lie about `place`; nothing if too few
// agree.
std::optional<Tie> tie_of(const std::vector<PassLandmark>& a, const std::vector<PassLandmark>& b,
                          const RoadPlace& place, const TieSettings& settings);

}  // namespace milepost
