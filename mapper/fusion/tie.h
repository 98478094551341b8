// How far the positions of two drives differ in one place.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "mapper/fusion/pass_landmark.h"

namespace milepost {

// A place of a stretch.
struct StretchPlace {
  std::size_t stretch = 0;
  double along_m = 0;
};

// The positions of `b` minus those of `a`, in metres east, north and up.
struct Tie {
  StretchPlace a, b;
  Eigen::Vector3d enu_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_m2 = Eigen::Matrix3d::Zero();
};

struct TieSettings {
  double max_offset_m = 4;    // between the positions of two drives
  double max_sigma_m = 3;     // of a landmark along its first ray, to be used
  double min_sigma_m = 0.03;  // of two positions of one landmark, seen from different lanes
  double tie_sigma_m = 0.02;  // of what all matches of a place have in common
  double cutoff_sigmas = 3;   // of inliers
  std::size_t min_inliers = 10;
  double min_inlier_ratio = 0.3;
};

// The tie of two drives from the landmarks of each that lie in one place; nothing if too few agree.
std::optional<Tie> tie_of(const std::vector<PassLandmark>& a, const std::vector<PassLandmark>& b,
                          const LocalFrame& local, const TieSettings& settings);

}  // namespace milepost
