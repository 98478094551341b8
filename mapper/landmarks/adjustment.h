// Bundle adjustment of a stretch of a mapping drive with its feature tracks.
#pragma once

#include <cstddef>
#include <vector>

#include "mapper/landmarks/feature_track.h"
#include "mapper/landmarks/image_witness.h"
#include "schema/geo/pinhole.h"

namespace milepost {

struct AdjustmentSettings {
  double position_sigma_m = 0.02;  // of a recorded position, or less, if the images say so, ...
  double least_position_sigma_m = 0.005;  // ... down to this
  double heading_sigma_deg = 0.5;         // of a recorded heading, without the mounting
  // Where the adjusted poses are off by more than so many of these sigmas, the images contradict
  // the record, and the sigma is what they say, up to the greatest.
  double contradicted_sigmas = 3;
  double greatest_position_sigma_m = 3;
  double greatest_heading_sigma_deg = 20;
  double mounting_sigma_deg = 3;  // of the camera's yaw against the recorded headings
  double tilt_sigma_deg = 3;      // of pitch and roll, recorded or of a level vehicle
  double pixel_sigma_px = 0.7;    // of a feature
  double max_first_rms_px = 16;   // tracks with a larger error at first ...
  double max_rms_px = 2.5;        // ... and after a first adjustment are discarded
  // If fewer of the tracks than this share fit at first, the start is a rough one: with ...
  double least_fitting = 0.7;
  double rough_position_sigma_m = 0.5;  // ... these errors of the record
  double rough_heading_sigma_deg = 5;
  std::size_t tracks_a_frame = 80;  // further tracks of a frame are discarded
  int max_passes = 5;               // two, or more while the record seems worse than thought
};

// Minimizes the reprojection errors of all tracks over `poses`, with the recorded poses (as given)
// as priors. How exact recorded positions and headings are from frame to frame is estimated on the
// way (variance components), so that images outweigh a record that they contradict. The first
// `final_frames` poses are constant. Single-threaded, so deterministic. Poses whose frames share no
// track with others stay near their priors. Returns what the images say of each frame beyond the
// constant ones; a track counts in the frame in its middle.
std::vector<ImageWitness> adjust_poses(std::vector<CameraPose>& poses, std::size_t final_frames,
                                       const std::vector<FeatureTrack>& tracks,
                                       const Pinhole& camera, const AdjustmentSettings& settings);

}  // namespace milepost
