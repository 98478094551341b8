// Which landmarks of two drives are of one feature.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "mapper/fusion/pass_landmark.h"
#include "schema/feature/root_sift.h"

namespace milepost {

// What landmarks are compared by. Positions are in one tangent frame.
struct ComparedLandmark {
  Eigen::Vector3d enu_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_m2 = Eigen::Matrix3d::Zero();
  double log_size = 0;
  RootSift descriptor{};
};

ComparedLandmark compared(const MappedLandmark& landmark, const LocalFrame& local);

// Squared distance of two descriptors, in [0, 2].
double squared_distance(const RootSift& a, const RootSift& b);

// Whether the sizes of two landmarks may be those of one feature.
bool are_of_one_size(const ComparedLandmark& a, const ComparedLandmark& b);

inline constexpr double kMaxSquaredDistance = 0.5;  // between descriptors of one feature

}  // namespace milepost
