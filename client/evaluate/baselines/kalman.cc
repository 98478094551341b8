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
  Eigen::Matrix2d transition;
  transition << 1, dt_s, 0, 1;
  Eigen::Matrix2d noise;
  noise << dt_s * dt_s * dt_s / 3, dt_s * dt_s / 2, dt_s * dt_s / 2, dt_s;
  noise *= acceleration_sigma * acceleration_sigma;
  return {transition * belief.mean,
          transition * belief.covariance * transition.transpose() + noise};
}

MotionBelief update(const MotionBelief& predicted, const Measurement& measurement) {
  const Eigen::RowVector2d observe(1, 0);
  const double variance_y = measurement.sigma_m * measurement.sigma_m;
  const double innovation_variance = predicted.covariance(0, 0) + variance_y;
  const Eigen::Vector2d gain = predicted.covariance.col(0) / innovation_variance;
  const Eigen::Matrix2d keep = Eigen::Matrix2d::Identity() - gain * observe;
  return {predicted.mean + gain * (measurement.along_m - predicted.mean[0]),
          keep * predicted.covariance * keep.transpose() + gain * variance_y * gain.transpose()};
}

}  // namespace milepost
