#include "client/localize/pose_belief.h"

#include <cmath>

#include <Eigen/Dense>

namespace milepost {
namespace {

// The process noise Q: white noise of acceleration and yaw acceleration, integrated over `t`
// seconds, and the random walks of position and mounting. `ahead` is the direction of travel.
StateMatrix process_noise(double t, const Eigen::Vector2d& ahead,
                          const PoseMotionSettings& settings) {
  StateMatrix Q = StateMatrix::Zero();
  const double a = settings.acceleration_sigma * settings.acceleration_sigma;
  Q.block<2, 2>(kEast, kEast) = a * t * t * t / 3 * ahead * ahead.transpose();
  Q.block<2, 1>(kEast, kSpeed) = a * t * t / 2 * ahead;
  Q.block<1, 2>(kSpeed, kEast) = a * t * t / 2 * ahead.transpose();
  Q(kSpeed, kSpeed) = a * t;
  const double w = settings.yaw_acceleration_sigma * settings.yaw_acceleration_sigma;
  Q(kHeading, kHeading) = w * t * t * t / 3;
  Q(kHeading, kYawRate) = Q(kYawRate, kHeading) = w * t * t / 2;
  Q(kYawRate, kYawRate) = w * t;
  const double slip = settings.slip_sigma * settings.slip_sigma * t;
  for (const int i : {kEast, kNorth, kUp}) Q(i, i) += slip;
  Q(kMounting, kMounting) = settings.mounting_sigma * settings.mounting_sigma * t;
  return Q;
}

// The lever arm of a vehicle that heads there, east and north; and its derivative.
Eigen::Vector2d turned(const LeverArm& lever, double heading_rad) {
  const double s = std::sin(heading_rad);
  const double c = std::cos(heading_rad);
  return {lever.forward_m * s + lever.right_m * c, lever.forward_m * c - lever.right_m * s};
}

Eigen::Vector2d turned_by_heading(const LeverArm& lever, double heading_rad) {
  const Eigen::Vector2d arm = turned(lever, heading_rad);
  return {arm.y(), -arm.x()};
}

}  // namespace

PoseBelief predict(const PoseBelief& belief, double elapsed_s, double slope,
                   const PoseMotionSettings& settings, const LeverArm& lever) {
  const double t = elapsed_s;
  const StateVector& x = belief.x;
  const double speed = x[kSpeed];
  const double mean_course_rad = x[kHeading] - x[kMounting] + x[kYawRate] * t / 2;
  const double s = std::sin(mean_course_rad);
  const double c = std::cos(mean_course_rad);

  PoseBelief next = belief;
  next.x[kEast] += speed * t * s;
  next.x[kNorth] += speed * t * c;
  next.x[kUp] += speed * t * slope;
  next.x[kHeading] += x[kYawRate] * t;
  const double headed_rad = x[kHeading] - x[kMounting];
  const double heads_rad = headed_rad + x[kYawRate] * t;
  next.x.segment<2>(kEast) += turned(lever, heads_rad) - turned(lever, headed_rad);

  StateMatrix F = StateMatrix::Identity();  // Jacobian of the prediction
  F(kEast, kSpeed) = t * s;
  F(kNorth, kSpeed) = t * c;
  F(kUp, kSpeed) = t * slope;
  F(kEast, kHeading) = speed * t * c;
  F(kNorth, kHeading) = -speed * t * s;
  F(kEast, kMounting) = -speed * t * c;
  F(kNorth, kMounting) = speed * t * s;
  F(kEast, kYawRate) = speed * t * c * t / 2;
  F(kNorth, kYawRate) = -speed * t * s * t / 2;
  F(kHeading, kYawRate) = t;
  const Eigen::Vector2d swing = turned_by_heading(lever, heads_rad);
  const Eigen::Vector2d swing_by_heading = swing - turned_by_heading(lever, headed_rad);
  F.block<2, 1>(kEast, kHeading) += swing_by_heading;
  F.block<2, 1>(kEast, kMounting) -= swing_by_heading;
  F.block<2, 1>(kEast, kYawRate) += t * swing;

  next.P = F * belief.P * F.transpose() + process_noise(t, {s, c}, settings);
  return next;
}

PoseBelief add_tilt_noise(const PoseBelief& belief, const PoseMotionSettings& settings) {
  PoseBelief next = belief;
  for (const int i : {kPitch, kRoll})
    next.P(i, i) += settings.tilt_sigma_rad * settings.tilt_sigma_rad;
  return next;
}

PoseBelief odometry_update(const PoseBelief& belief, double speed_mps, double yaw_rate,
                           const OdometrySettings& settings) {
  const StateVector& x = belief.x;
  const StateMatrix& P = belief.P;
  const double scale = 1 + x[kOdometryScale];
  const Eigen::Vector2d z(speed_mps, yaw_rate);                               // the measurement ...
  const Eigen::Vector2d h(scale * x[kSpeed], x[kYawRate] + x[kYawRateBias]);  // ... as predicted
  Eigen::Matrix<double, 2, kStates> H = Eigen::Matrix<double, 2, kStates>::Zero();  // dh/dx
  H(0, kSpeed) = scale;
  H(0, kOdometryScale) = x[kSpeed];
  H(1, kYawRate) = H(1, kYawRateBias) = 1;
  const Eigen::Vector2d sigmas(settings.speed_sigma_mps, settings.yaw_rate_sigma);
  const Eigen::Matrix2d R = sigmas.cwiseAbs2().asDiagonal();  // measurement noise
  const Eigen::Matrix2d S = H * P * H.transpose() + R;        // innovation covariance
  const Eigen::Matrix<double, kStates, 2> K = P * H.transpose() * S.inverse();  // gain
  const StateMatrix I_KH = StateMatrix::Identity() - K * H;

  PoseBelief updated;
  updated.x = x + K * (z - h);
  updated.P = I_KH * P * I_KH.transpose() + K * R * K.transpose();  // Joseph form
  return updated;
}

}  // namespace milepost
