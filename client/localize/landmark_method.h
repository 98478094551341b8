// The default method: by landmarks.
#pragma once

#include "client/localize/estimate.h"
#include "client/localize/landmark_matching.h"
#include "client/localize/method.h"
#include "client/localize/pose_consensus.h"

namespace milepost {

struct LandmarkMethod {
  LandmarkMatchSettings match;
  PoseSolverSettings solver;
  ConsensusSettings consensus;
  PoseMotionSettings motion;
  WheelSettings wheels;
  RobustSettings vote;              // over along, where a start is looked for
  int max_start_places = 3;         // of the densest votes, tried in a frame ...
  double start_places_apart_m = 4;  // ... and so far apart
  // A frame is taken in that speaks for the place as much as this, and by this part of what frames
  // said of late ...
  double min_log_bayes_factor = 0;
  double min_usual_part = 0.15;
  double min_searched_log_bayes_factor = 2;  // ... and, not found where it was expected, for it.
  // A frame of so many features that is not taken in speaks so against the place at least.
  int min_seeing_features = 30;
  double log_bayes_factor_of_nothing = -3;

  // What is believed at the start, about the line where the votes are densest.
  double start_along_sigma_m = 2;
  double start_region_m = 12;  // in which its landmarks were mapped
  double start_lateral_sigma_m = 2.5;
  double start_up_sigma_m = 0.5;
  double start_heading_sigma_deg = 6;
  double start_tilt_sigma_deg = 2.5;
  double start_speed_mps = 8;
  double start_speed_sigma_mps = 10;
  double start_yaw_rate_sigma = 0.2;  // rad/s
  double mounting_sigma_deg = 2;
  double wheel_scale_sigma = 0.03;
  double yaw_rate_bias_sigma = 0.01;  // rad/s
  double focal_sigma = 0.005;         // of a calibration, as part of the focal length ...
  double principal_sigma = 0.002;     // ... and of the principal point, in focal lengths

  double min_region_m = 1;  // searched to either side, beside ...
  double region_sigmas = 3;
  double max_expected_sigma_m =
      0.8;                          // of along, up to which landmarks are searched in their places
  int min_support = 5;              // matches that agree, when each was found in its place
  double min_agreeing_part = 0.35;  // of the matches found in their places
  double search_widening = 3;       // of the belief's sigmas, where they were not found there
  double min_sigma_m = 0.02;        // of along and lateral: what maps themselves may be off
  // Frames that miss much of what they should show are less exact than what they find agrees:
  // variance, as told, grows by so much times the square of the part that is missed.
  double missed_variance = 6;
  // Landmarks at an end of the line were seen on one side of it only: the variance there is 1 +
  // end_variance times as much, and falls so fast inside.
  double end_variance = 8;
  double end_reach_m = 3;
};

inline constexpr const char* kDefaultMethod = "milepost";

// Along, lateral and heading, by matches, a pose, and the belief that carries it on.
Method landmark_method(const LandmarkMethod& settings = {});

}  // namespace milepost
