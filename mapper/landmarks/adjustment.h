// Bundle adjustment of a stretch of a mapping drive with its feature tracks.
#pragma once

#include <cstddef>
#include <vector>

#include "mapper/landmarks/feature_track.h"
#include "schema/geo/pinhole.h"

namespace milepost {

struct AdjustmentSettings {
  double position_sigma_m = 0.02;  // of a recorded position at first; then what the images say, ...
  double least_position_sigma_m = 0.005;  // ... between this and that
  double heading_sigma_deg = 0.5;         // of a recorded heading, without the mounting
  double mounting_sigma_deg = 3;          // of the camera's yaw against the recorded headings
  double tilt_sigma_deg = 3;              // of pitch and roll, which no drive records
  double pixel_sigma_px = 0.7;            // of a feature
  double max_first_rms_px = 16;           // tracks with a larger error at first ...
  double max_rms_px = 2.5;                // ... and after a first adjustment are discarded
  std::size_t tracks_a_frame = 80;        // further tracks of a frame are discarded
};

// Minimizes the reprojection errors of all tracks over `poses`, with the recorded poses (as given)
// as priors. How exact recorded positions are from frame to frame is estimated on the way (variance
// components). The first `final_frames` poses are constant. Single-threaded, so deterministic.
// Poses whose frames share no track with others stay near their priors.
void adjust_poses(std::vector<CameraPose>& poses, std::size_t final_frames,
                  const std::vector<FeatureTrack>& tracks, const Pinhole& camera,
                  const AdjustmentSettings& settings);

}  // namespace milepost
