// What the localizer believes of the camera's pose and motion, and how both go on.
#pragma once

#include <cmath>

#include <Eigen/Core>

#include "schema/geo/camera_pose.h"
#include "schema/geo/pinhole.h"

namespace milepost {

// The state: the camera's pose in a tangent frame; how far its calibration is off, which is learned
// on the way: the logarithm of the true focal length over the given one, and the shift of the
// principal point in focal lengths; the vehicle's speed and yaw rate; and, learned on the way, too:
// the yaw of the camera's mounting against the direction of travel (clockwise), and by how much the
// wheels tell too much, as part of the speed and as radians a second of the yaw rate.
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
  kWheelScale,
  kYawRateBias,
  kStates
};

using StateVector = Eigen::Matrix<double, kStates, 1>;
using StateMatrix = Eigen::Matrix<double, kStates, kStates>;

struct PoseBelief {
  StateVector mean = StateVector::Zero();  // metres, radians, seconds
  StateMatrix covariance = StateMatrix::Zero();

  CameraPose pose() const {
    return {mean.segment<3>(kEast), mean[kHeading], mean[kPitch], mean[kRoll]};
  }
  // The camera as it is believed to be, from the one given.
  Pinhole camera(const Pinhole& given) const {
    const double factor = std::exp(mean[kLogFocal]);
    return {given.focal_x_px * factor, given.focal_y_px * factor,
            given.principal_x_px + given.focal_x_px * mean[kPrincipalX],
            given.principal_y_px + given.focal_y_px * mean[kPrincipalY]};
  }
};

struct PoseMotionSettings {
  double acceleration_sigma = 2.0;      // m/s^2 / sqrt(Hz)
  double yaw_acceleration_sigma = 0.4;  // rad/s^2 / sqrt(Hz)
  double slip_sigma = 0.05;             // m / sqrt(s), in each direction
  double tilt_sigma_rad = 0.012;        // of pitch and roll from frame to frame, whatever the time
  double mounting_sigma = 0.001;        // rad / sqrt(s)
};

// What the wheels' word is worth, beside the errors that last.
struct WheelSettings {
  double speed_sigma_mps = 0.1;
  double yaw_rate_sigma = 0.01;  // rad/s
};

// The belief `elapsed_s` later: constant speed and yaw rate. `slope` is the road's, upwards.
// REQUIRES: elapsed_s >= 0.
PoseBelief predicted(const PoseBelief& belief, double elapsed_s, double slope,
                     const PoseMotionSettings& settings);

// The belief in the next frame, in which the camera may have tilted, whatever the time.
PoseBelief tilted(const PoseBelief& belief, const PoseMotionSettings& settings);

// The belief with what the wheels say at its time; the yaw rate clockwise, in radians a second.
PoseBelief with_wheels(const PoseBelief& belief, double speed_mps, double yaw_rate,
                       const WheelSettings& settings);

}  // namespace milepost
