// Places a landmark by its bearings from known poses.
#pragma once

#include <optional>

#include "mapper/landmarks/pixel_track.h"
#include "schema/geo/pinhole.h"

namespace milepost {

struct PlacedPoint {
  Eigen::Vector3d enu_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_m2 = Eigen::Matrix3d::Zero();
  double rms_px = 0;  // of its pixels about the images of the point
};

// The point whose images are the nearest to the track's pixels, each pixel as uncertain as
// `pixel_sigma_px`. Nothing if it does not lie before every camera or the rays are parallel.
// REQUIRES: two sights or more.
std::optional<PlacedPoint> triangulate(const PixelTrack& track,
                                       const std::vector<CameraPose>& poses, const Pinhole& camera,
                                       double pixel_sigma_px);

}  // namespace milepost
