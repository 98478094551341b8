// The default method: localization by landmarks.
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
  OdometrySettings odometry;
  RobustSettings vote;              // over arc length, to initialize and relocalize
  int max_start_places = 3;         // of the strongest votes, tried per frame ...
  double start_places_apart_m = 4;  // ... at least this far apart
  // A frame is used for the update if its log Bayes factor is at least this, and at least this part
  // of the recent average ...
  double min_log_bayes_factor = 0;
  double min_usual_part = 0.15;
  double min_relocalized_log_bayes_factor = 2;  // ... and this, if found by global matching.
  // A frame with at least min_seeing_features that is not used contradicts the belief; if no pose
  // near it fits, its log Bayes factor is set to at most log_bayes_factor_of_nothing.
  int min_seeing_features = 30;
  double log_bayes_factor_of_nothing = -3;

  // The initial belief, on the line at the densest votes.
  double start_along_sigma_m = 2;
  double start_region_m = 12;  // around the start, in which its landmarks were mapped
  double start_lateral_sigma_m = 2.5;
  double start_up_sigma_m = 0.5;
  double start_heading_sigma_deg = 6;
  double start_tilt_sigma_deg = 2.5;
  double start_speed_mps = 8;
  double start_speed_sigma_mps = 10;
  double start_yaw_rate_sigma = 0.2;  // rad/s
  double mounting_sigma_deg = 2;
  double odometry_scale_sigma = 0.03;
  double yaw_rate_bias_sigma = 0.01;  // rad/s
  double focal_sigma = 0.005;         // of the calibration, relative to the focal length ...
  double principal_sigma = 0.002;     // ... and of the principal point, in focal lengths

  double min_region_m = 1;             // half width of the region searched, plus ...
  double region_sigmas = 3;            // ... this many sigmas of arc length
  double max_guided_sigma_m = 0.8;     // of arc length, up to which guided matching is used
  int min_support = 5;                 // inliers of guided matching
  double min_agreeing_part = 0.35;     // inlier ratio of guided matching
  double relocalization_widening = 3;  // factor of the belief's sigmas for global matching
  double min_sigma_m = 0.02;           // of arc length and lateral offset: error of the map
  // Frames in which many predicted landmarks are missed are less accurate than their inliers
  // suggest: the reported variance is multiplied by 1 + missed_variance times the square of the
  // missed part.
  double missed_variance = 6;
  // Landmarks at an end of the line were seen from one side only: the reported variance there is
  // multiplied by 1 + end_variance; the addend decays with exp(-distance / end_reach_m).
  double end_variance = 8;
  double end_reach_m = 3;
};

inline constexpr const char* kDefaultMethod = "milepost";

// Estimates arc length, lateral offset and heading: matching, pose estimation and a Kalman filter.
Method landmark_method(const LandmarkMethod& settings = {});

}  // namespace milepost
