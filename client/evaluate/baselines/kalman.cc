#include "client/evaluate/baselines/kalman.h"

namespace milepost {

double constant_velocity_step_m(double before_m, double before_s, double latest_m, double latest_s,
                                double now_s) {
  return (latest_m - before_m) / (latest_s - before_s) * (now_s - latest_s);
}

AlongBelief predict(const AlongBelief& belief, double step_m, double sigma_w_m) {
  return {belief.along_m + step_m, belief.variance_m2 + sigma_w_m * sigma_w_m};
}

AlongBelief update(const AlongBelief& predicted, const Measurement& measurement,
                   double variance_weight) {
  const double variance_y = variance_weight * measurement.sigma_m * measurement.sigma_m;
  const double gain = predicted.variance_m2 / (predicted.variance_m2 + variance_y);  // Eq. 11
  return {predicted.along_m + gain * (measurement.along_m - predicted.along_m),
          (1 - gain) * predicted.variance_m2};
}

MotionBelief predict(const MotionBelief& belief, double dt_s, double acceleration_sigma) {
  Eigen::Matrix2d F;  // transition
  F << 1, dt_s, 0, 1;
  Eigen::Matrix2d Q;  // process noise
  Q << dt_s * dt_s * dt_s / 3, dt_s * dt_s / 2, dt_s * dt_s / 2, dt_s;
  Q *= acceleration_sigma * acceleration_sigma;
  return {F * belief.x, F * belief.P * F.transpose() + Q};
}

MotionBelief update(const MotionBelief& predicted, const Measurement& measurement) {
  const Eigen::Vector2d& x = predicted.x;
  const Eigen::Matrix2d& P = predicted.P;
  const double z = measurement.along_m;
  const double R = measurement.sigma_m * measurement.sigma_m;
  const Eigen::RowVector2d H(1, 0);
  const double S = P(0, 0) + R;
  const Eigen::Vector2d K = P.col(0) / S;  // gain
  const Eigen::Matrix2d I_KH = Eigen::Matrix2d::Identity() - K * H;
  return {x + K * (z - x[0]), I_KH * P * I_KH.transpose() + K * R * K.transpose()};
}

}  // namespace milepost
