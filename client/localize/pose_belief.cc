#include "client/localize/pose_belief.h"

#include <cmath>

#include <Eigen/Dense>

namespace milepost {

PoseBelief predicted(const PoseBelief& belief, double elapsed_s, double slope,
                     const PoseMotionSettings& settings) {
  PoseBelief next = belief;
  const double t = elapsed_s;
  const double speed = belief.mean[kSpeed];
  const double yaw_rate = belief.mean[kYawRate];
  const double course_rad =
      belief.mean[kHeading] - belief.mean[kMounting] + yaw_rate * t / 2;  // half way
  const double s = std::sin(course_rad);
  const double c = std::cos(course_rad);
  next.mean[kEast] += speed * t * s;
  next.mean[kNorth] += speed * t * c;
  next.mean[kUp] += speed * t * slope;
  next.mean[kHeading] += yaw_rate * t;

  StateMatrix by_state = StateMatrix::Identity();
  by_state(kEast, kSpeed) = t * s;
  by_state(kNorth, kSpeed) = t * c;
  by_state(kUp, kSpeed) = t * slope;
  by_state(kEast, kHeading) = speed * t * c;
  by_state(kNorth, kHeading) = -speed * t * s;
  by_state(kEast, kMounting) = -speed * t * c;
  by_state(kNorth, kMounting) = speed * t * s;
  by_state(kEast, kYawRate) = speed * t * c * t / 2;
  by_state(kNorth, kYawRate) = -speed * t * s * t / 2;
  by_state(kHeading, kYawRate) = t;

  // White noise of acceleration and of yaw acceleration, integrated over the time.
  StateMatrix noise = StateMatrix::Zero();
  const double a = settings.acceleration_sigma * settings.acceleration_sigma;
  const Eigen::Vector2d ahead(s, c);
  noise.block<2, 2>(kEast, kEast) = a * t * t * t / 3 * ahead * ahead.transpose();
  noise.block<2, 1>(kEast, kSpeed) = a * t * t / 2 * ahead;
  noise.block<1, 2>(kSpeed, kEast) = a * t * t / 2 * ahead.transpose();
  noise(kSpeed, kSpeed) = a * t;
  const double w = settings.yaw_acceleration_sigma * settings.yaw_acceleration_sigma;
  noise(kHeading, kHeading) = w * t * t * t / 3;
  noise(kHeading, kYawRate) = noise(kYawRate, kHeading) = w * t * t / 2;
  noise(kYawRate, kYawRate) = w * t;
  const double slip = settings.slip_sigma * settings.slip_sigma * t;
  for (const int i : {kEast, kNorth, kUp}) noise(i, i) += slip;
  noise(kMounting, kMounting) = settings.mounting_sigma * settings.mounting_sigma * t;

  next.covariance = by_state * belief.covariance * by_state.transpose() + noise;
  return next;
}

PoseBelief tilted(const PoseBelief& belief, const PoseMotionSettings& settings) {
  PoseBelief next = belief;
  for (const int i : {kPitch, kRoll})
    next.covariance(i, i) += settings.tilt_sigma_rad * settings.tilt_sigma_rad;
  return next;
}

PoseBelief with_wheels(const PoseBelief& belief, double speed_mps, double yaw_rate,
                       const WheelSettings& settings) {
  const double scale = 1 + belief.mean[kWheelScale];
  Eigen::Matrix<double, 2, kStates> observe = Eigen::Matrix<double, 2, kStates>::Zero();
  observe(0, kSpeed) = scale;
  observe(0, kWheelScale) = belief.mean[kSpeed];
  observe(1, kYawRate) = observe(1, kYawRateBias) = 1;
  const Eigen::Vector2d expected(scale * belief.mean[kSpeed],
                                 belief.mean[kYawRate] + belief.mean[kYawRateBias]);
  const Eigen::Vector2d sigmas(settings.speed_sigma_mps, settings.yaw_rate_sigma);
  const Eigen::Matrix2d noise = sigmas.cwiseAbs2().asDiagonal();
  const Eigen::Matrix2d innovation = observe * belief.covariance * observe.transpose() + noise;
  const Eigen::Matrix<double, kStates, 2> gain =
      belief.covariance * observe.transpose() * innovation.inverse();
  const StateMatrix keep = StateMatrix::Identity() - gain * observe;
  PoseBelief with;
  with.mean = belief.mean + gain * (Eigen::Vector2d(speed_mps, yaw_rate) - expected);
  with.covariance = keep * belief.covariance * keep.transpose() + gain * noise * gain.transpose();
  return with;
}

}  // namespace milepost
