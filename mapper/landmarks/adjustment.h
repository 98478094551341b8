// Refines the poses of a stretch of a mapping drive from its own tracks (bundle adjustment).
#pragma once

#include <cstddef>
#include <vector>

#include "mapper/landmarks/pixel_track.h"
#include "schema/geo/pinhole.h"

namespace milepost {

struct AdjustmentSettings {
  double position_sigma_m = 0.02;   // of a recorded position
  double heading_sigma_deg = 0.5;   // of a recorded heading, beside what the camera's mounting adds
  double mounting_sigma_deg = 3;    // of the camera's yaw against the recorded headings
  double tilt_sigma_deg = 3;        // of pitch and roll, which no drive records
  double pixel_sigma_px = 0.7;      // of a feature
  double max_first_rms_px = 16;     // tracks that fit worse at first ...
  double max_rms_px = 2.5;          // ... and after a first adjustment are left out
  std::size_t tracks_a_frame = 80;  // beyond so many, further tracks of a frame are left out
};

// Moves `poses` where the images of all tracks' points are the nearest to their pixels, with the
// recorded poses (as given) for priors. The first `settled` poses stay as they are. One thread, so
// the same input gives the same poses. Poses whose frames share no track with others stay near
// their priors.
void adjust_poses(std::vector<CameraPose>& poses, std::size_t settled,
                  const std::vector<PixelTrack>& tracks, const Pinhole& camera,
                  const AdjustmentSettings& settings);

}  // namespace milepost
