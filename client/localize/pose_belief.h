// The state of the localizer's filter: the camera's pose and motion, and their prediction.
#pragma once

#include <cmath>

#include <Eigen/Core>

#include "schema/geo/camera_pose.h"
#include "schema/geo/pinhole.h"

namespace milepost {

// The components of the state x: the camera's pose in a local tangent frame; corrections of its
// calibration, estimated online: the logarithm of the true over the given focal length, and the
// shift of the principal point in focal lengths; the vehicle's speed and yaw rate; and, also
// estimated online, the yaw of the camera's mounting relative to the direction of travel
// (clockwise), the relative excess of odometry speed, and the bias of the odometry yaw rate
// (rad/s).
enum PoseState : int {
  kEast,
  kNorth,
  kUp,
  kHeading,
  kPitch,
  kRoll,
  kLogFocal,
  kPrincipalX,
  kPrincipalY,
  kSpeed,
  kYawRate,
  kMounting,
  kOdometryScale,
  kYawRateBias,
  kStates
};

using StateVector = Eigen::Matrix<double, kStates, 1>;
using StateMatrix = Eigen::Matrix<double, kStates, kStates>;

// A Gaussian with mean x and covariance P.
struct PoseBelief {
  StateVector x = StateVector::Zero();  // metres, radians, seconds
  StateMatrix P = StateMatrix::Zero();

  CameraPose pose() const { return {x.segment<3>(kEast), x[kHeading], x[kPitch], x[kRoll]}; }
  // The given camera with the estimated corrections.
  Pinhole camera(const Pinhole& given) const {
    const double factor = std::exp(x[kLogFocal]);
    return {given.focal_x_px * factor, given.focal_y_px * factor,
            given.principal_x_px + given.focal_x_px * x[kPrincipalX],
            given.principal_y_px + given.focal_y_px * x[kPrincipalY]};
  }
};

struct PoseMotionSettings {
  double acceleration_sigma = 2.0;      // m/s^2 / sqrt(Hz)
  double yaw_acceleration_sigma = 0.4;  // rad/s^2 / sqrt(Hz)
  double slip_sigma = 0.05;             // m / sqrt(s), in each direction
  double tilt_sigma_rad = 0.012;        // of pitch and roll, per frame
  double mounting_sigma = 0.001;        // rad / sqrt(s)
};

// White noise of odometry, in addition to its scale error and bias.
struct OdometrySettings {
  double speed_sigma_mps = 0.1;
  double yaw_rate_sigma = 0.01;  // rad/s
};

// Where the camera is beside the point of the vehicle that goes where the vehicle heads: where it
// turns, the camera swings out.
struct LeverArm {
  double forward_m = 0;
  double right_m = 0;
};

// Prediction by `elapsed_s` with constant speed and yaw rate. `slope` is that of the road, upwards.
// REQUIRES: elapsed_s >= 0.
PoseBelief predict(const PoseBelief& belief, double elapsed_s, double slope,
                   const PoseMotionSettings& settings, const LeverArm& lever = {});

// Adds the process noise of pitch and roll from one frame to the next, which does not depend on
// time.
PoseBelief add_tilt_noise(const PoseBelief& belief, const PoseMotionSettings& settings);

// The Kalman update with an odometry reading at the belief's time; the yaw rate in rad/s,
// clockwise.
PoseBelief odometry_update(const PoseBelief& belief, double speed_mps, double yaw_rate,
                           const OdometrySettings& settings);

}  // namespace milepost
