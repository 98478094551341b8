// Triangulates a landmark from its pixels and known poses.
#pragma once

#include <optional>

#include "mapper/landmarks/feature_track.h"
#include "schema/geo/pinhole.h"

namespace milepost {

struct TriangulatedPoint {
  Eigen::Vector3d enu_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_m2 = Eigen::Matrix3d::Zero();
  double rms_px = 0;  // reprojection error, in pixels of the frames
};

// The point that minimizes the reprojection error of the track, whose pixels have the standard
// deviation `pixel_sigma_px` in the frames. Nothing if it is not in front of every camera or the
// rays are parallel. REQUIRES: two or more observations.
std::optional<TriangulatedPoint> triangulate(const FeatureTrack& track,
                                             const std::vector<CameraPose>& poses,
                                             const Pinhole& camera, double pixel_sigma_px);

}  // namespace milepost
